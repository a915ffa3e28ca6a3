// SPDX-License-Identifier: MIT
#include "common/study/told_frames.h"

#include <algorithm>

namespace mmm_converter {
namespace {

constexpr int kLooks = 24;
constexpr double kJointDeviation = 1;    // that a joint is expected to have [rad]
constexpr double kRootDeviation = 10;    // [m], [rad]: anywhere
constexpr double kHeldDeviation = 0.01;  // of a joint at a limit, and how near that is [rad]

}  // namespace

std::vector<int> LookedAt(int num_frames) {
  const long looks = std::min(num_frames, kLooks);
  std::vector<int> frames;
  for (long i = 0; i < looks; ++i) {
    frames.push_back(static_cast<int>((2 * i + 1) * num_frames / (2 * looks)));
  }
  return frames;
}

Eigen::VectorXd PostureInformation(const MarkerKinematics& kinematics, const Posture& posture) {
  Eigen::VectorXd information(kinematics.num_dofs());
  information.head<6>().setConstant(1 / (kRootDeviation * kRootDeviation));
  for (int j = 0; j < kinematics.num_joints(); ++j) {
    const double angle = posture.joint_angles[j];
    const bool is_at_limit = angle < kinematics.lower()[j] + kHeldDeviation ||
                             angle > kinematics.upper()[j] - kHeldDeviation;
    const double deviation = is_at_limit ? kHeldDeviation : kJointDeviation;
    information[6 + j] = 1 / (deviation * deviation);
  }
  return information;
}

}  // namespace mmm_converter
