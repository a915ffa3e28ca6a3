// SPDX-License-Identifier: MIT
#include "common/judge/coverage.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "common/model/kit_joints.h"
#include "common/model/marker_kinematics.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

constexpr double kLongGap = 1;  // [s]

Limb* FindLimb(const std::string& name, std::vector<Limb>* limbs) {
  const auto found = std::find_if(limbs->begin(), limbs->end(),
                                  [&](const Limb& limb) { return limb.name == name; });
  if (found != limbs->end()) return &*found;
  limbs->push_back({name, 0, 0, {}});
  return &limbs->back();
}

// The longest run of frames in which `is_known` says no to the number of labels that are seen.
template <typename IsKnown>
std::optional<Gap> LongestGap(const std::string& what, const std::vector<LabelIx>& labels,
                              const MarkerSequence& recording, const IsKnown& is_known) {
  std::optional<Gap> longest;
  int begin = 0;
  for (int k = 0; k < recording.num_frames(); ++k) {
    const auto frame = recording.frame(k);
    const auto seen = std::count_if(labels.begin(), labels.end(),
                                    [&](int label) { return IsSeen(frame.col(label)); });
    if (is_known(static_cast<int>(seen))) {
      begin = k + 1;
    } else if (!longest || k - begin > longest->last_frame - longest->first_frame) {
      longest = Gap{what, begin, k, (k - begin + 1) / recording.rate()};
    }
  }
  return longest;
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
    if (!limb.IsKnownBy(static_cast<int>(limb.labels.size()))) {
      unshown.push_back("the " + limb.name);
    } else if (limb.free_joints > 0) {
      unshown.push_back(
          fmt::format("{} of {} joints of the {}", limb.free_joints, limb.num_joints, limb.name));
    }
  }
  return unshown.empty() ? "" : JoinNames(unshown, " and ");
}

std::vector<Gap> LongGaps(const TrackingSetup& setup, const std::vector<Limb>& limbs,
                          const MarkerSequence& recording) {
  std::vector<Gap> gaps;
  const auto of_body = LongestGap("the body", LabelIndices(setup.assignments()), recording,
                                  [](int seen) { return seen > 0; });
  if (of_body) gaps.push_back(*of_body);
  for (const Limb& limb : limbs) {
    if (!limb.IsKnownBy(static_cast<int>(limb.labels.size()))) continue;
    const auto gap = LongestGap("the " + limb.name, limb.labels, recording,
                                [&](int seen) { return limb.IsKnownBy(seen); });
    const bool is_bodys = gap && of_body && gap->first_frame == of_body->first_frame &&
                          gap->last_frame == of_body->last_frame;
    if (gap && !is_bodys) gaps.push_back(*gap);
  }
  std::erase_if(gaps, [](const Gap& gap) { return gap.seconds <= kLongGap; });
  return gaps;
}

}  // namespace mmm_converter
