// SPDX-License-Identifier: MIT
#include "tests/common/retarget/squat.h"

#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "common/io/mmm/mmm_model.h"
#include "common/model/forward_kinematics.h"
#include "common/model/model_scaling.h"
#include "tests/support/shared_data.h"

namespace mmm_converter::testing {
namespace {

/// Of a person who stands at the origin.
struct LegLengths {
  double thigh, shank;
  double low;  ///< height of the soles below the root
};

LegLengths MeasureLegs(const KinematicModel& person) {
  const auto X_WS = SegmentPoses(person, ZeroPosture(person));
  const auto place = [&](const char* joint) -> Eigen::Vector3d {
    return X_WS[person.FindSegment(joint)].translation();
  };
  return {(place("LHy_joint") - place("LKx_joint")).norm(),
          (place("LKx_joint") - place("LAy_joint")).norm(), place("LeftFootHeight_joint").z()};
}

}  // namespace

KinematicModel Person(double height) {
  return ScaleWinter(ReadMmmModel(SourcePath("xml_config/models/mmm.xml")), {height, 70, {}});
}

PoseTrajectory Squat(const KinematicModel& person) {
  PoseTrajectory motion;
  motion.rate = 100;
  const std::vector<std::pair<std::string, double>> joints = {
      {"LHx_joint", 1}, {"RHx_joint", 1}, {"LKx_joint", -2}, {"RKx_joint", -2},
      {"LAx_joint", 1}, {"RAx_joint", 1}, {"LSx_joint", 2}};
  for (const auto& [name, share] : joints) motion.joint_names.push_back(name);
  const auto [thigh, shank, low] = MeasureLegs(person);
  for (int k = 0; k < 200; ++k) {
    const double bend = 0.25 * (1 - std::cos(2 * std::numbers::pi * k / 100));
    Posture posture;
    posture.joint_angles.resize(static_cast<Eigen::Index>(joints.size()));
    for (std::size_t i = 0; i < joints.size(); ++i) {
      posture.joint_angles[static_cast<Eigen::Index>(i)] = bend * joints[i].second;
    }
    posture.position = {0, (thigh - shank) * -std::sin(bend),
                        -low - (thigh + shank) * (1 - std::cos(bend))};
    motion.postures.push_back(posture);
  }
  return motion;
}

PoseTrajectory Shuffle(const KinematicModel& person, double step, double lift) {
  constexpr double kLower = 0.06;  // [m] than upright, so that legs reach their places
  PoseTrajectory motion;
  motion.rate = 100;
  motion.joint_names = {"LHx_joint", "LKx_joint", "LAx_joint",
                        "RHx_joint", "RKx_joint", "RAx_joint"};
  const auto [thigh, shank, low] = MeasureLegs(person);
  for (int k = 0; k < 300; ++k) {
    Posture posture;
    posture.joint_angles.resize(6);
    posture.position = {0, step * k / 100, -low - kLower};
    for (int i = 0; i < 2; ++i) {
      const int shifted = k + 50 * i;
      const double part = std::max(0, shifted % 100 - 60) / 40.0;
      const double swing = part * part * part * (10 - 15 * part + 6 * part * part);
      const double middle = step * (0.3 - 0.5 * i);  // of a stance, under the hips
      const int strides = shifted / 100;
      const double ahead = step * (strides + swing) + middle - posture.position.y();
      const double lifted = lift * std::pow(std::sin(std::numbers::pi * part), 2);
      const double below = thigh + shank - kLower - lifted;
      const double way = std::hypot(ahead, below);
      const double knee =
          std::acos((way * way - thigh * thigh - shank * shank) / (2 * thigh * shank));
      const double hip = std::atan2(ahead, below) + std::asin(shank * std::sin(knee) / way);
      posture.joint_angles.segment<3>(3 * i) << hip, -knee, knee - hip;
    }
    motion.postures.push_back(posture);
  }
  return motion;
}

}  // namespace mmm_converter::testing
