// SPDX-License-Identifier: MIT
#include "common/judge/coverage.h"

#include <fmt/format.h>

#include <algorithm>

#include "common/model/kit_joints.h"
#include "common/model/marker_kinematics.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

// [s]. A prediction bridges the first while other limbs hold the body, the second alone.
constexpr double kLongGapOfLimb = 1;
constexpr double kLongGapOfBody = 0.5;

Limb* FindLimb(const std::string& name, std::vector<Limb>* limbs) {
  const auto found = std::find_if(limbs->begin(), limbs->end(),
                                  [&](const Limb& limb) { return limb.name == name; });
  if (found != limbs->end()) return &*found;
  limbs->push_back({name, 0, 0, {}});
  return &limbs->back();
}

// The longest runs of frames, at most `most` of those that last `least` [s], in which `is_known`
// says no to the number of labels that are seen; in the order of time.
template <typename IsKnown>
std::vector<Gap> LongestGaps(const std::string& what, double least, std::size_t most,
                             const std::vector<LabelIx>& labels, const MarkerSequence& recording,
                             const IsKnown& is_known) {
  std::vector<Gap> gaps;
  int begin = 0;
  for (int k = 0; k <= recording.num_frames(); ++k) {
    if (k < recording.num_frames()) {
      const auto frame = recording.frame(k);
      const auto seen = std::count_if(labels.begin(), labels.end(),
                                      [&](int label) { return IsSeen(frame.col(label)); });
      if (!is_known(static_cast<int>(seen))) continue;
    }
    const Gap gap{what, begin, k - 1, (k - begin) / recording.rate()};
    if (gap.seconds >= least) gaps.push_back(gap);
    begin = k + 1;
  }
  std::stable_sort(gaps.begin(), gaps.end(),
                   [](const Gap& a, const Gap& b) { return a.seconds > b.seconds; });
  gaps.resize(std::min(gaps.size(), most));
  std::stable_sort(gaps.begin(), gaps.end(),
                   [](const Gap& a, const Gap& b) { return a.first_frame < b.first_frame; });
  return gaps;
}

// How long `gap` goes on beyond another one [s]; all of it, where they do not meet.
double SecondsBeyond(const Gap& gap, const Gap& other, double rate) {
  const int common =
      std::min(gap.last_frame, other.last_frame) - std::max(gap.first_frame, other.first_frame) + 1;
  return gap.seconds - std::max(0, common) / rate;
}

// Of the model: those that no assigned marker moves, and UntoldJoints.
std::vector<int> UnshownJoints(const TrackingSetup& setup) {
  const MarkerKinematics kinematics(*setup.model, setup.joints, MarkerIndices(setup.assignments()));
  std::vector<int> unshown;
  for (int joint = 0; joint < setup.model->num_joints(); ++joint) {
    const auto& tracked = kinematics.joints();
    const auto found = std::find(tracked.begin(), tracked.end(), joint);
    bool is_shown = false;
    for (int m = 0; m < kinematics.num_markers() && found != tracked.end(); ++m) {
      is_shown = is_shown || kinematics.Moves(static_cast<int>(found - tracked.begin()), m);
    }
    if (!is_shown) unshown.push_back(joint);
  }
  return unshown;
}

}  // namespace

std::vector<Limb> LimbsOf(const TrackingSetup& setup) {
  const MarkerKinematics kinematics(*setup.model, setup.joints, MarkerIndices(setup.assignments()));
  std::vector<Limb> limbs;
  for (int j = 0; j < kinematics.num_joints(); ++j) {
    const std::string name = LimbOfJoint(setup.model->joint(kinematics.joints()[j]).name);
    if (name.empty()) continue;
    Limb* limb = FindLimb(name, &limbs);
    ++limb->num_joints;
    bool is_free = true;
    for (int m = 0; m < kinematics.num_markers(); ++m) {
      if (!kinematics.Moves(j, m)) continue;
      is_free = false;
      const LabelIx label = setup.assignments()[static_cast<std::size_t>(m)].label;
      if (std::count(limb->labels.begin(), limb->labels.end(), label) > 0) continue;
      limb->labels.push_back(label);
    }
    if (is_free) ++limb->free_joints;
  }
  return limbs;
}

std::string DescribeUnshown(const std::vector<Limb>& limbs) {
  std::vector<std::string> unshown;
  for (const Limb& limb : limbs) {
    const int told = 3 * static_cast<int>(limb.labels.size());
    const int missing = std::max(limb.free_joints, limb.num_joints - told);
    if (limb.labels.empty()) {
      unshown.push_back("the " + limb.name);
    } else if (missing > 0) {
      unshown.push_back(
          fmt::format("{} of {} joints of the {}", missing, limb.num_joints, limb.name));
    }
  }
  return unshown.empty() ? "" : JoinNames(unshown, " and ");
}

AnatomicalAngles ShownAngles(const TrackingSetup& setup, const PoseTrajectory& motion) {
  return WithoutJoints(ComputeAnatomicalAngles(*setup.model, motion), UnshownJoints(setup));
}

std::vector<Gap> LongGaps(const TrackingSetup& setup, const std::vector<Limb>& limbs,
                          const MarkerSequence& recording) {
  constexpr std::size_t kMost = 3;
  std::vector<Gap> gaps =
      LongestGaps("the body", kLongGapOfBody, kMost, LabelIndices(setup.assignments()), recording,
                  [](int seen) { return seen > 0; });
  const std::size_t of_body = gaps.size();
  for (const Limb& limb : limbs) {
    if (!limb.IsKnownBy(static_cast<int>(limb.labels.size()))) continue;
    const auto longest = LongestGaps("the " + limb.name, kLongGapOfLimb, 1, limb.labels, recording,
                                     [&](int seen) { return limb.IsKnownBy(seen); });
    for (const Gap& gap : longest) {
      const bool is_bodys = std::any_of(
          gaps.begin(), gaps.begin() + static_cast<std::ptrdiff_t>(of_body), [&](const Gap& body) {
            return SecondsBeyond(gap, body, recording.rate()) < kLongGapOfLimb;
          });
      if (!is_bodys) gaps.push_back(gap);
    }
  }
  return gaps;
}

}  // namespace mmm_converter
