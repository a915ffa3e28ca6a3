// SPDX-License-Identifier: MIT
#include "common/study/body_limits.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <tuple>
#include <utility>
#include <vector>

#include "common/convert/tracking_setup.h"
#include "common/fit/posture_fit.h"
#include "common/math/statistics.h"
#include "common/model/forward_kinematics.h"
#include "common/model/joint_limits.h"
#include "common/model/kit_joints.h"
#include "common/model/marker_kinematics.h"
#include "common/model/posture.h"
#include "common/motion/flat_frames.h"
#include "common/motion/marker_sequence.h"
#include "common/motion/marker_synthesis.h"
#include "common/motion/pose_trajectory.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

constexpr double kFurtherBack = 30 / kDegrees;
constexpr std::size_t kFittedFrames = 40;

/// How far a knee of the reference model, which ends where the leg is straight, would bend
/// backwards in these frames, in which it is at that limit [rad]: the median of some of them, which
/// are fitted anew with a limit that lies further back. joint: tracked, of the model; frames: not
/// empty.
double KneeBeyondStraight(const TrackingSetup& setup, const MarkerSequence& recording,
                          const PoseTrajectory& trajectory, int joint,
                          const std::vector<int>& frames) {
  const double upper = setup.model->joint(joint).upper;
  const KinematicModel model = WithUpperLimit(*setup.model, joint, upper + kFurtherBack);
  const auto& assignments = setup.assignments();
  const MarkerKinematics kinematics(model, setup.joints, MarkerIndices(assignments));
  const auto column = std::find(setup.joints.begin(), setup.joints.end(), joint);
  PostureFit fit(kinematics);
  Eigen::VectorXd scale(static_cast<Eigen::Index>(assignments.size()));
  for (std::size_t i = 0; i < assignments.size(); ++i) {
    scale[static_cast<Eigen::Index>(i)] = assignments[i].noise_scale;
  }
  std::vector<double> angles;
  const std::size_t count = std::min(frames.size(), kFittedFrames);
  for (std::size_t i = 0; i < count; ++i) {
    const int k = frames[i * frames.size() / count];
    const Eigen::Matrix3Xd z = recording.frame(k)(Eigen::all, LabelIndices(assignments));
    Posture posture = trajectory.postures[static_cast<std::size_t>(k)];
    fit.Solve(z, scale, {}, &posture);
    angles.push_back(posture.joint_angles[column - setup.joints.begin()] - upper);
  }
  return Median(angles);
}

constexpr double kAtLimitWithin = 0.5 / kDegrees;
// A limit this near the joint's rest is how people stand.
constexpr double kNearRest = 5 / kDegrees;
constexpr double kUpright = 0.7;  // cosine of 45 degrees
constexpr std::size_t kFewestFlatFrames = 5;
constexpr int kMostPostures = 500;
constexpr int kFewestShowing = 2;  // markers; one takes up where it is worn

/// Nobody says where joints are in frames that show too few markers.
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

std::vector<JointAtLimit> MeasureLegJoints(const TrackingSetup& setup,
                                           const MarkerSequence& recording,
                                           const PoseTrajectory& trajectory) {
  const std::vector<int> seen = SeenFrames(setup, recording, trajectory.num_frames());
  std::vector<JointAtLimit> joints;
  if (seen.empty()) return joints;
  const auto num_seen = static_cast<double>(seen.size());
  const KinematicModel& model = *setup.model;
  const MarkerKinematics kinematics(model, setup.joints, MarkerIndices(setup.assignments()));
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
    JointAtLimit& one = joints.emplace_back();
    one.joint = joint.name;
    one.share = frames / num_seen;
    one.straight = static_cast<double>(straight.size()) / num_seen;
    if (one.straight > kStandsAtLimit) {
      one.bent_back = KneeBeyondStraight(setup, recording, trajectory,
                                         setup.joints[static_cast<std::size_t>(j)], straight);
    }
  }
  return joints;
}

std::vector<FoldedLeg> MeasureLegs(const KinematicModel& model, const PoseTrajectory& trajectory) {
  std::vector<FoldedLeg> legs;
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
    legs.push_back({side, upright == 0 ? kNaN : folded / upright});
  }
  return legs;
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

std::vector<FlatSole> MeasureSoles(const TrackingSetup& setup, const MarkerSequence& recording,
                                   const PoseTrajectory& trajectory) {
  std::vector<FlatSole> soles;
  const KinematicModel& model = *setup.model;
  for (const auto& [side, letter] : {std::pair("left", "L"), std::pair("right", "R")}) {
    const std::string prefix = letter;
    const int foot = model.FindSegment(prefix + "Ay_joint");
    const int front = model.FindSegment(prefix + "Mrot_joint");
    const int shank_end = model.FindSegment(prefix + "Asegment_joint");
    if (foot < 0 || front < 0 || shank_end < 0) continue;
    const std::vector<int> labels = LabelsOfFoot(setup, shank_end, foot, front);
    std::vector<double> slopes;
    const Eigen::Vector2d ramp = FindRamp(recording, labels);
    const Eigen::Vector3d up = Eigen::Vector3d(-ramp.x(), -ramp.y(), 1).normalized();
    for (const int k : FlatFrames(recording, labels, ramp)) {
      if (k >= trajectory.num_frames()) break;
      const auto X_WS = SegmentPoses(model, ModelPosture(model, trajectory, k));
      // The sole is level in the posture that is all zero.
      slopes.push_back(std::asin(up.dot(X_WS[static_cast<std::size_t>(foot)].linear().col(1))));
    }
    soles.push_back({side, slopes.size() < kFewestFlatFrames ? kNaN : Median(slopes)});
  }
  return soles;
}

}  // namespace

BodyLimits MeasureBodyLimits(const TrackingSetup& setup, const MarkerSequence& recording,
                             const PoseTrajectory& trajectory) {
  if (trajectory.postures.empty() || setup.model->FindSegment("LHsegment_joint") < 0) return {};
  return {MeasureLegJoints(setup, recording, trajectory), MeasureLegs(*setup.model, trajectory),
          MeasureSoles(setup, recording, trajectory)};
}

}  // namespace mmm_converter
