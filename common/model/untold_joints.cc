// SPDX-License-Identifier: MIT
#include "common/model/untold_joints.h"

#include <algorithm>
#include <limits>
#include <string>

#include "common/model/forward_kinematics.h"

namespace mmm_converter {
namespace {

constexpr double kAcross = 0.125;  // share of the shank's length

/// Markers of a part of a foot.
struct Part {
  int count = 0;
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -std::numeric_limits<double>::infinity();

  void Add(double across) {
    ++count;
    lowest = std::min(lowest, across);
    highest = std::max(highest, across);
  }
};

}  // namespace

std::vector<int> UntoldJoints(const KinematicModel& model, const std::vector<MarkerIx>& markers) {
  std::vector<int> untold;
  for (const std::string side : {"L", "R"}) {
    const int foot = model.FindSegment(side + "Ay_joint");
    const int front = model.FindSegment(side + "Mrot_joint");
    const int ankle = model.FindSegment(side + "Asegment_joint");
    if (foot < 0 || front < 0 || ankle < 0) continue;
    const auto X_WS = SegmentPoses(model, ZeroPosture(model));
    Part whole, forefoot;
    for (const MarkerIx index : markers) {
      const ModelMarker& marker = model.markers()[index];
      if (!model.IsBelow(marker.segment, foot)) continue;
      const double across = (X_WS[static_cast<std::size_t>(marker.segment)] * marker.p_SM).x();
      whole.Add(across);
      if (model.IsBelow(marker.segment, front)) forefoot.Add(across);
    }
    const double apart =
        kAcross * model.segments()[static_cast<std::size_t>(ankle)].X_PF.translation().norm();
    const auto add = [&](int segment) {
      const int joint = model.segments()[static_cast<std::size_t>(segment)].joint;
      if (joint >= 0) untold.push_back(joint);
    };
    if (whole.highest - whole.lowest < apart) add(foot);
    const bool is_told =
        forefoot.highest - forefoot.lowest >= apart && whole.count - forefoot.count >= 2;
    if (!is_told) add(front);
  }
  return untold;
}

}  // namespace mmm_converter
