// SPDX-License-Identifier: MIT
#include "common/study/knee_limits.h"

#include <algorithm>
#include <vector>

#include "common/fit/posture_fit.h"
#include "common/math/statistics.h"
#include "common/model/joint_limits.h"
#include "common/model/marker_kinematics.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

constexpr double kFurtherBack = 30 / kDegrees;
constexpr std::size_t kFittedFrames = 40;

}  // namespace

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

}  // namespace mmm_converter
