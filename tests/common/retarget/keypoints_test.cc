// SPDX-License-Identifier: MIT
#include "common/retarget/keypoints.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "common/model/forward_kinematics.h"
#include "common/motion/marker_synthesis.h"
#include "common/motion/pose_trajectory.h"
#include "tests/common/retarget/squat.h"

namespace mmm_converter {
namespace {

constexpr double kHeight = 1.8;

int IndexOf(const std::string& name) {
  const std::vector<std::string>& names = KeypointNames();
  return static_cast<int>(std::find(names.begin(), names.end(), name) - names.begin());
}

TEST(KeypointsTest, LimbsAreTheModelsJointsInTheOrderOfSmplX) {
  const KinematicModel person = testing::Person(kHeight);
  const PoseTrajectory motion = testing::Squat(person);
  const HumanBody body = FindHumanBody(person);
  const Eigen::MatrixXd points = Keypoints(MoveHuman(person, body, motion), kHeight, motion.rate);
  ASSERT_EQ(points.rows(), 3 * 22);
  ASSERT_EQ(points.cols(), motion.num_frames());
  const int k = motion.num_frames() / 2;
  const auto X_WS = SegmentPoses(person, ModelPosture(person, motion, k));
  for (const auto& [name, joint] :
       std::vector<std::pair<std::string, std::string>>{{"L_Hip", "LHx_joint"},
                                                        {"R_Hip", "RHx_joint"},
                                                        {"L_Knee", "LKx_joint"},
                                                        {"L_Ankle", "LAx_joint"},
                                                        {"L_Shoulder", "LSx_joint"},
                                                        {"R_Elbow", "REx_joint"},
                                                        {"R_Wrist", "RWx_joint"}}) {
    const int segment = person.FindSegment(joint);
    ASSERT_GE(segment, 0) << joint;
    EXPECT_TRUE(
        points.col(k).segment<3>(3 * IndexOf(name)).isApprox(X_WS[segment].translation(), 1e-9))
        << name;
  }
  EXPECT_GT(points(3 * IndexOf("L_Hip") + 2, 0), points(3 * IndexOf("L_Foot") + 2, 0) + 0.5);
  EXPECT_NEAR((points.col(k).segment<3>(3 * IndexOf("Head")) -
               points.col(k).segment<3>(3 * IndexOf("Neck")))
                  .norm(),
              0.1 * kHeight, 1e-9);
}

TEST(KeypointsTest, AnotherRateIsBetweenTheFrames) {
  const KinematicModel person = testing::Person(kHeight);
  const PoseTrajectory motion = testing::Squat(person);
  const HumanMotion moved = MoveHuman(person, FindHumanBody(person), motion);
  const Eigen::MatrixXd all = Keypoints(moved, kHeight, motion.rate);
  const Eigen::MatrixXd some = Keypoints(moved, kHeight, 0.4 * motion.rate);
  ASSERT_EQ(some.cols(), (all.cols() - 1) * 2 / 5 + 1);
  EXPECT_TRUE(some.col(2).isApprox(all.col(5), 1e-12));
  EXPECT_TRUE(some.col(3).isApprox(0.5 * (all.col(7) + all.col(8)), 1e-12));
}

}  // namespace
}  // namespace mmm_converter
