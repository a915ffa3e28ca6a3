// SPDX-License-Identifier: MIT
#include "plugins/s2kf/gated_update.h"

namespace mmm_converter::s2kf {

namespace {

// Of a frame, until no more markers are left out.
constexpr int kPasses = 4;

}  // namespace

GatedUpdate::GatedUpdate(const TrackedMarkers& markers, double probability)
    : gate_(markers.kinematics(), markers.mirror(), probability),
      is_active_(probability > 0),
      prior_at_(markers.kinematics().MakeJacobian()) {
  prior_posture_.joint_angles.setZero(markers.kinematics().num_joints());
}

void GatedUpdate::Update(MarkerFilter* filter, Belief* belief, GateState* gate,
                         TrackedFrame* frame) {
  prior_ = *belief;
  if (is_active_ && gate->IsAnyWrong()) {
    filter->Place(prior_, &prior_posture_, &prior_at_);
    gate_.Reconsider(frame->measured, prior_at_, gate);
  }
  UpdateBySelected(filter, *gate, belief, frame);
  if (!is_active_ || frame->outcome.seen == 0) return;
  if (gate->IsAnyWrong() || gate_.IsSuspicious(*gate, frame->z, frame->at)) {
    Judge(filter, belief, gate, frame);
  }
  gate_.Learn(frame->z, frame->at, gate);
}

void GatedUpdate::UpdateBySelected(MarkerFilter* filter, const GateState& gate, Belief* belief,
                                   TrackedFrame* frame) {
  gate.Select(frame->measured, &frame->relabelled, &frame->z);
  *belief = prior_;
  filter->Update(frame->z, belief, &frame->outcome);
  filter->Place(*belief, &frame->posture, &frame->at);
}

void GatedUpdate::Judge(MarkerFilter* filter, Belief* belief, GateState* gate,
                        TrackedFrame* frame) {
  const auto update_again = [&] {
    UpdateBySelected(filter, *gate, belief, frame);
    gate_.Expect(*gate, frame->z, frame->at, frame->outcome);
  };
  filter->Place(prior_, &prior_posture_, &prior_at_);
  if (gate_.ExchangeByPrior(frame->measured, prior_at_, gate)) {
    update_again();
  } else {
    gate_.Expect(*gate, frame->z, frame->at, frame->outcome);
  }
  for (int i = 0; i < kPasses && gate_.LeaveOutWorst(frame->z, gate); ++i) update_again();
  if (gate->IsAnyWrong() && gate_.Settle(frame->measured, frame->outcome, gate)) update_again();
  gate_.MoveOffsets(frame->at, gate);
}

}  // namespace mmm_converter::s2kf
