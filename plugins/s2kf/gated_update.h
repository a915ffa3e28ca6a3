// SPDX-License-Identifier: MIT
#pragma once

#include "plugins/s2kf/marker_filter.h"
#include "plugins/s2kf/marker_gate.h"
#include "plugins/s2kf/tracked_frame.h"
#include "plugins/s2kf/tracked_markers.h"

namespace mmm_converter::s2kf {

/// Updates a belief by those markers of a frame that are right: the one place where the filter and
/// the gate meet. State in, state out; what it holds is scratch and constants. Nothing is allocated
/// after construction.
class GatedUpdate {
 public:
  /// probability: as MarkerGate; 0: every marker is right. markers must outlive the update.
  GatedUpdate(const TrackedMarkers& markers, double probability);

  /// belief: predicted, then the posterior. gate: advanced by the frame's step, then the judgement
  /// of this frame. frame->measured is read; z, outcome, posture and at are written. May be called
  /// again in a frame, from another belief.
  void Update(MarkerFilter* filter, Belief* belief, GateState* gate, TrackedFrame* frame);

 private:
  void UpdateBySelected(MarkerFilter* filter, const GateState& gate, Belief* belief,
                        TrackedFrame* frame);
  /// Finds what is wrong in a suspicious frame, and updates without it.
  void Judge(MarkerFilter* filter, Belief* belief, GateState* gate, TrackedFrame* frame);

  MarkerGate gate_;
  bool is_active_;
  Belief prior_;
  Posture prior_posture_;
  MarkerJacobian prior_at_;
};

}  // namespace mmm_converter::s2kf
