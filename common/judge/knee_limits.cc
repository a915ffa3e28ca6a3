// SPDX-License-Identifier: MIT
#include "common/judge/knee_limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "common/fit/posture_fit.h"
#include "common/math/statistics.h"
#include "common/model/marker_kinematics.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

constexpr double kStraightWithin = 0.5 / kDegrees;
constexpr double kFurtherBack = 30 / kDegrees;
constexpr double kLeastShare = 0.05;  // of the frames, as of other joints at their limits
constexpr std::size_t kFittedFrames = 40;
// [rad] of the median. Persons scaled by their height stand up to 8 degrees off a knee's stored
// angle.
constexpr Limit kBendsBack = {0.1 / kDegrees, kNever};

KinematicModel WithUpperLimit(const KinematicModel& model, int joint, double upper) {
  ModelDescription description = DescriptionOf(model);
  for (Segment& segment : description.segments) {
    if (segment.joint == joint) segment.upper = upper;
  }
  return KinematicModel(std::move(description));
}

/// How far back the knee bends in each of these frames [rad], where its limit lets it.
std::vector<double> FreeAngles(const TrackingSetup& setup, const MarkerSequence& recording,
                               const PoseTrajectory& trajectory, int joint,
                               const std::vector<int>& frames) {
  const double upper = setup.model->joint(joint).upper;
  const KinematicModel model = WithUpperLimit(*setup.model, joint, upper + kFurtherBack);
  const MarkerKinematics kinematics(model, setup.joints, MarkerIndices(setup.assignments()));
  const auto column = std::find(setup.joints.begin(), setup.joints.end(), joint);
  PostureFit fit(kinematics);
  const auto& assignments = setup.assignments();
  Eigen::VectorXd scale(static_cast<Eigen::Index>(assignments.size()));
  for (std::size_t i = 0; i < assignments.size(); ++i) {
    scale[static_cast<Eigen::Index>(i)] = assignments[i].noise_scale;
  }
  std::vector<double> angles;
  for (const int k : frames) {
    const Eigen::Matrix3Xd z = recording.frame(k)(Eigen::all, LabelIndices(assignments));
    Posture posture = trajectory.postures[static_cast<std::size_t>(k)];
    fit.Solve(z, scale, {}, &posture);
    angles.push_back(posture.joint_angles[column - setup.joints.begin()] - upper);
  }
  return angles;
}

}  // namespace

void JudgeKnees(const TrackingSetup& setup, const MarkerSequence& recording,
                const PoseTrajectory& trajectory, VerdictReasons* reasons) {
  for (const auto& [side, name] :
       {std::pair("left", "LKx_joint"), std::pair("right", "RKx_joint")}) {
    const int joint = setup.model->FindJoint(name);
    const auto column = std::find(setup.joints.begin(), setup.joints.end(), joint);
    if (joint < 0 || column == setup.joints.end()) continue;
    const double upper = setup.model->joint(joint).upper;
    std::vector<int> straight;
    for (int k = 0; k < trajectory.num_frames(); ++k) {
      const Posture& posture = trajectory.postures[static_cast<std::size_t>(k)];
      const double angle = posture.joint_angles[column - setup.joints.begin()];
      if (angle > upper - kStraightWithin) straight.push_back(k);
    }
    const double share =
        static_cast<double>(straight.size()) / std::max(1, trajectory.num_frames());
    if (share < kLeastShare) continue;
    std::vector<int> some;
    const std::size_t count = std::min(straight.size(), kFittedFrames);
    for (std::size_t i = 0; i < count; ++i) some.push_back(straight[i * straight.size() / count]);
    const double back = Median(FreeAngles(setup, recording, trajectory, joint, some));
    reasons->AddBeyond(
        kBendsBack, back,
        fmt::format("the {} knee bends backwards by its markers, by about {:.0f} degrees in "
                    "{:.0f} % of the frames; the model's knee ends straight, and hip and ankle "
                    "take it up",
                    side, kDegrees * back, kPercent * share));
  }
}

}  // namespace mmm_converter
