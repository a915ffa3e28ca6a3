// SPDX-License-Identifier: MIT
#include "common/retarget/keypoints.h"

#include <algorithm>
#include <cmath>

namespace mmm_converter {
namespace {

using Eigen::Vector3d;

constexpr double kCollar = 1.0 / 3;  // of the way from the neck to a shoulder
constexpr double kHead = 0.1;        // of the height, above the neck
constexpr double kRounding = 1e-9;   // of a frame

Eigen::VectorXd KeypointsOf(const HumanMotion& motion, double height, int k) {
  const BodyPosture& body = motion.bodies[k];
  const auto& [left_leg, right_leg] = body.legs;
  const auto& [left_arm, right_arm] = body.arms;
  const Vector3d neck = 0.5 * (left_arm.proximal + right_arm.proximal);
  const auto spine = [&](double part) -> Vector3d {
    return body.mid_hip + part * (neck - body.mid_hip);
  };
  const auto collar = [&](const LimbPosture& arm) -> Vector3d {
    return neck + kCollar * (arm.proximal - neck);
  };
  const Vector3d head = neck + kHead * height * body.R_chest.col(2);
  Eigen::VectorXd points(3 * KeypointNames().size());
  points << body.mid_hip, left_leg.proximal, right_leg.proximal, spine(0.25), left_leg.middle,
      right_leg.middle, spine(0.5), left_leg.distal, right_leg.distal, spine(0.75),
      motion.toes[0].col(k), motion.toes[1].col(k), neck, collar(left_arm), collar(right_arm), head,
      left_arm.proximal, right_arm.proximal, left_arm.middle, right_arm.middle, left_arm.distal,
      right_arm.distal;
  return points;
}

}  // namespace

const std::vector<std::string>& KeypointNames() {
  static const std::vector<std::string> names = {
      "Pelvis",  "L_Hip",    "R_Hip",    "Spine1", "L_Knee",     "R_Knee",
      "Spine2",  "L_Ankle",  "R_Ankle",  "Spine3", "L_Foot",     "R_Foot",
      "Neck",    "L_Collar", "R_Collar", "Head",   "L_Shoulder", "R_Shoulder",
      "L_Elbow", "R_Elbow",  "L_Wrist",  "R_Wrist"};
  return names;
}

Eigen::MatrixXd Keypoints(const HumanMotion& motion, double height, double rate) {
  const int last = motion.num_frames() - 1;
  const double step = motion.rate / rate;
  const int count = last < 0 ? 0 : static_cast<int>(std::floor(last / step + kRounding)) + 1;
  Eigen::MatrixXd points(3 * KeypointNames().size(), count);
  for (int i = 0; i < count; ++i) {
    const double at = std::min(i * step, static_cast<double>(last));
    const int k = std::min(static_cast<int>(at), std::max(0, last - 1));
    const int next = std::min(k + 1, last);
    const double part = at - k;
    points.col(i) = (1 - part) * KeypointsOf(motion, height, k);
    if (part > 0) points.col(i) += part * KeypointsOf(motion, height, next);
  }
  return points;
}

}  // namespace mmm_converter
