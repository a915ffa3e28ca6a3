// SPDX-License-Identifier: MIT
#include "common/calibrate/segment_lengths.h"

#include <algorithm>
#include <string>

#include "common/model/kit_joints.h"

namespace mmm_converter {
namespace {

/// For each segment whether it or one below it is in `segments`.
std::vector<bool> CarriesOneOf(const KinematicModel& model, const std::vector<int>& segments) {
  std::vector<bool> carries(model.segments().size(), false);
  for (int s : segments) {
    for (; s >= 0 && !carries[s]; s = model.segments()[s].parent) carries[s] = true;
  }
  return carries;
}

}  // namespace

std::string LengthName(const KinematicModel& model, const SegmentLengths& lengths, int length) {
  const std::string& name = model.segments()[lengths.segments[length]].name;
  return lengths.are_of_axes ? name + ' ' + "xyz"[length % 3] : name;
}

SegmentLengths FindSegmentLengths(const KinematicModel& model, const std::vector<int>& joints,
                                  const std::vector<MarkerIx>& markers) {
  std::vector<int> joint_segments;
  joint_segments.reserve(joints.size());
  for (const int joint : joints) joint_segments.push_back(model.joint_segment(joint));
  std::vector<int> marker_segments;
  marker_segments.reserve(markers.size());
  for (const int marker : markers) marker_segments.push_back(model.markers()[marker].segment);
  const std::vector<bool> has_joint = CarriesOneOf(model, joint_segments);
  const std::vector<bool> has_marker = CarriesOneOf(model, marker_segments);

  SegmentLengths lengths;
  for (int s = 1; s < static_cast<int>(model.segments().size()); ++s) {
    const bool is_length = model.segments()[s].X_PF.translation().squaredNorm() > 0;
    if (is_length && has_joint[s] && has_marker[s]) lengths.segments.push_back(s);
  }
  for (int i = 0; i < static_cast<int>(lengths.segments.size()); ++i) {
    const int other = model.FindSegment(MirroredName(model.segments()[lengths.segments[i]].name));
    const auto found = std::find(lengths.segments.begin() + i, lengths.segments.end(), other);
    if (other < 0 || found == lengths.segments.end()) continue;
    lengths.mirror.emplace_back(i, static_cast<int>(found - lengths.segments.begin()));
  }
  return lengths;
}

}  // namespace mmm_converter
