// SPDX-License-Identifier: MIT
#include "common/judge/body_limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "common/judge/knee_limits.h"
#include "common/math/statistics.h"
#include "common/model/forward_kinematics.h"
#include "common/model/kit_joints.h"
#include "common/model/marker_kinematics.h"
#include "common/model/posture.h"
#include "common/motion/flat_frames.h"
#include "common/motion/marker_synthesis.h"
#include "common/support/text.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

// Share of the frames: joints of right recordings at most 0.03.
constexpr Limit kBodyAtLimit = {0.05, kNever};
constexpr double kAtLimitWithin = 0.5 / kDegrees;
// A limit this near the joint's rest is how people stand.
constexpr double kNearRest = 5 / kDegrees;
// A straight knee is at its limit, and at rest. Markers of uncalibrated persons in the walks of 24
// laboratories show it at most 3 degrees beyond; those of a shank that was turned back by 15, 7.
constexpr double kKneeBeyond = 5 / kDegrees;
// Who walks on hands is not upright; who kicks is not so for long.
constexpr Limit kAnkleAboveHip = {0.2, kNever};
constexpr double kUpright = 0.7;  // cosine of 45 degrees
// Of a foot that lies flat [degrees]: shoes and places of markers differ.
constexpr Limit kSlopeOfSole = {15, kNever};
constexpr std::size_t kFewestFlatFrames = 5;
constexpr int kMostPostures = 500;
constexpr int kFewestShowing = 2;  // markers; one takes up where it is worn

/// Of frames that show too few markers nobody says where joints are.
std::vector<int> SeenFrames(const TrackingSetup& setup, const MarkerSequence& recording,
                            int num_frames) {
  std::vector<int> seen;
  for (int k = 0; k < std::min(num_frames, recording.num_frames()); ++k) {
    const auto frame = recording.frame(k);
    const auto count =
        std::count_if(setup.assignments().begin(), setup.assignments().end(),
                      [&](const MarkerAssignment& one) { return IsSeen(frame.col(one.label)); });
    if (count >= kFewestMarkers) seen.push_back(k);
  }
  return seen;
}

void JudgeJoints(const TrackingSetup& setup, const MarkerSequence& recording,
                 const PoseTrajectory& trajectory, const std::vector<int>& seen, bool is_calibrated,
                 VerdictReasons* reasons) {
  if (seen.empty()) return;
  const KinematicModel& model = *setup.model;
  const MarkerKinematics kinematics(model, setup.joints, MarkerIndices(setup.assignments()));
  std::vector<std::string> standing;
  double most = 0;
  for (int j = 0; j < kinematics.num_joints(); ++j) {
    int moved = 0;
    for (int m = 0; m < kinematics.num_markers(); ++m) moved += kinematics.Moves(j, m) ? 1 : 0;
    const Segment& joint = model.joint(setup.joints[static_cast<std::size_t>(j)]);
    const bool is_leg = LimbOfJoint(joint.name).ends_with("leg");
    if (!is_leg || moved < kFewestShowing || HasNoLimits(joint)) continue;
    const bool is_knee = joint.name.ends_with("Kx_joint");
    std::vector<int> straight;
    double frames = 0;
    for (const int k : seen) {
      const double angle = trajectory.postures[static_cast<std::size_t>(k)].joint_angles[j];
      const bool is_low =
          angle < joint.lower + kAtLimitWithin && joint.lower < joint.rest - kNearRest;
      const bool is_high =
          angle > joint.upper - kAtLimitWithin && joint.upper > joint.rest + kNearRest;
      frames += is_low || is_high ? 1 : 0;
      if (is_knee && angle > joint.upper - kAtLimitWithin) straight.push_back(k);
    }
    std::string beyond;
    if (kBodyAtLimit.IsBeyond(static_cast<double>(straight.size()) / seen.size())) {
      const double back = KneeBeyondStraight(setup, recording, trajectory,
                                             setup.joints[static_cast<std::size_t>(j)], straight);
      if (back > kKneeBeyond) {
        frames = static_cast<double>(straight.size());
        beyond = fmt::format(", bent backwards by {:.0f} degrees", kDegrees * back);
      }
    }
    const double share = frames / static_cast<double>(seen.size());
    if (!kBodyAtLimit.IsBeyond(share)) continue;
    standing.push_back(fmt::format("{} ({:.0f} %{})", joint.name, kPercent * share, beyond));
    most = std::max(most, share);
  }
  const char* advice = is_calibrated ? "" : " Calibrating the person finds where they are worn.";
  reasons->AddBeyond(kBodyAtLimit, most,
                     fmt::format("joints stand at their limits, in more than {:.0f} % of the "
                                 "frames: {}; are their markers where their names say?{}",
                                 kPercent * kBodyAtLimit.check, FirstNames(standing, 6), advice));
}

void JudgeLegs(const KinematicModel& model, const PoseTrajectory& trajectory,
               VerdictReasons* reasons) {
  for (const auto& [side, hip, ankle] : {std::tuple("left", "LHx_joint", "LAx_joint"),
                                         std::tuple("right", "RHx_joint", "RAx_joint")}) {
    const int above = model.FindSegment(hip), below = model.FindSegment(ankle);
    if (above < 0 || below < 0) continue;
    double upright = 0, folded = 0;
    const int step = 1 + trajectory.num_frames() / kMostPostures;
    for (int k = 0; k < trajectory.num_frames(); k += step) {
      const auto X_WS = SegmentPoses(model, ModelPosture(model, trajectory, k));
      if (X_WS.front().linear()(2, 2) < kUpright) continue;
      ++upright;
      const double hip_height = X_WS[static_cast<std::size_t>(above)].translation().z();
      folded += X_WS[static_cast<std::size_t>(below)].translation().z() > hip_height ? 1 : 0;
    }
    if (upright == 0) continue;
    reasons->AddBeyond(kAnkleAboveHip, folded / upright,
                       fmt::format("the {} ankle is above its hip in {:.0f} % of the frames in "
                                   "which the pelvis is upright: is it a leg's marker?",
                                   side, kPercent * folded / upright));
  }
}

/// Columns of the markers below an ankle, or at it; empty where they are not at both its ends.
std::vector<int> LabelsOfFoot(const TrackingSetup& setup, int shank_end, int foot, int front) {
  std::vector<int> labels;
  int in_front = 0;
  for (const MarkerAssignment& one : setup.assignments()) {
    int segment = setup.model->markers()[one.marker].segment;
    bool is_in_front = false, is_foot = false;
    for (; segment > 0;
         segment = setup.model->segments()[static_cast<std::size_t>(segment)].parent) {
      is_in_front |= segment == front;
      is_foot |= segment == foot || segment == shank_end;
      if (segment == shank_end) break;
    }
    if (!is_foot) continue;
    labels.push_back(one.label);
    in_front += is_in_front ? 1 : 0;
  }
  const bool are_both_ends = in_front > 0 && in_front < static_cast<int>(labels.size());
  return are_both_ends ? labels : std::vector<int>();
}

void JudgeSoles(const TrackingSetup& setup, const MarkerSequence& recording,
                const PoseTrajectory& trajectory, VerdictReasons* reasons) {
  const KinematicModel& model = *setup.model;
  for (const auto& [side, letter] : {std::pair("left", "L"), std::pair("right", "R")}) {
    const std::string prefix = letter;
    const int foot = model.FindSegment(prefix + "Ay_joint");
    const int front = model.FindSegment(prefix + "Mrot_joint");
    const int shank_end = model.FindSegment(prefix + "Asegment_joint");
    if (foot < 0 || front < 0 || shank_end < 0) continue;
    const std::vector<int> labels = LabelsOfFoot(setup, shank_end, foot, front);
    std::vector<double> slopes;
    const Eigen::Vector2d ramp = RampOf(recording, labels);
    const Eigen::Vector3d up = Eigen::Vector3d(-ramp.x(), -ramp.y(), 1).normalized();
    for (const int k : FlatFrames(recording, labels, ramp)) {
      if (k >= trajectory.num_frames()) break;
      const auto X_WS = SegmentPoses(model, ModelPosture(model, trajectory, k));
      // The sole is level in the posture that is all zero.
      slopes.push_back(std::asin(up.dot(X_WS[static_cast<std::size_t>(foot)].linear().col(1))));
    }
    if (slopes.size() < kFewestFlatFrames) continue;
    const double slope = kDegrees * std::abs(Median(slopes));
    reasons->AddBeyond(kSlopeOfSole, slope,
                       fmt::format("the {} foot's sole slopes by {:.0f} degrees where its markers "
                                   "lie flat: are they where their names say?",
                                   side, slope));
  }
}

}  // namespace

void JudgeBodyLimits(const TrackingSetup& setup, const MarkerSequence& recording,
                     const PoseTrajectory& trajectory, bool is_calibrated,
                     VerdictReasons* reasons) {
  // Of the reference model: robots and OpenSim's bodies have limits of their own kinds.
  if (trajectory.postures.empty() || setup.model->FindSegment("LHsegment_joint") < 0) return;
  JudgeJoints(setup, recording, trajectory, SeenFrames(setup, recording, trajectory.num_frames()),
              is_calibrated, reasons);
  JudgeLegs(*setup.model, trajectory, reasons);
  JudgeSoles(setup, recording, trajectory, reasons);
}

}  // namespace mmm_converter
