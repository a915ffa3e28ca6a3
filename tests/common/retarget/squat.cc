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
  const double thigh =
      (SegmentPoses(person, ZeroPosture(person))[person.FindSegment("LHy_joint")].translation() -
       SegmentPoses(person, ZeroPosture(person))[person.FindSegment("LKx_joint")].translation())
          .norm();
  const double shank =
      (SegmentPoses(person, ZeroPosture(person))[person.FindSegment("LKx_joint")].translation() -
       SegmentPoses(person, ZeroPosture(person))[person.FindSegment("LAy_joint")].translation())
          .norm();
  const double low =
      SegmentPoses(person, ZeroPosture(person))[person.FindSegment("LeftFootHeight_joint")]
          .translation()
          .z();
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

}  // namespace mmm_converter::testing
