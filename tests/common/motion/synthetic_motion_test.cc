// SPDX-License-Identifier: MIT
#include "common/motion/synthetic_motion.h"
#include "common/model/kit_joints.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "common/io/mmm/mmm_model.h"
#include "common/math/rotation.h"
#include "common/model/forward_kinematics.h"
#include "common/model/model_scaling.h"
#include "common/motion/marker_synthesis.h"
#include "common/support/error.h"
#include "tests/support/acrobatics.h"
#include "tests/support/shared_data.h"

namespace mmm_converter {
namespace {

using Eigen::Vector3d;

constexpr double kDegree = std::numbers::pi / 180;

class SyntheticMotionTest : public ::testing::Test {
 protected:
  Vector3d Node(const PoseTrajectory& motion, int k, const std::string& name) const {
    return SegmentPoses(model_, ModelPosture(model_, motion, k))[model_.FindSegment(name)]
        .translation();
  }

  double LowestMarker(const PoseTrajectory& motion, int k) const {
    return MarkerPositions(model_, ModelPosture(model_, motion, k)).row(2).minCoeff();
  }

  /// Root roll, pitch, yaw without jumps [rad].
  static std::vector<Vector3d> Rpy(const PoseTrajectory& motion) {
    std::vector<Vector3d> rpy = {Vector3d::Zero()};
    for (const Posture& posture : motion.postures) {
      rpy.push_back(
          ContinuousRpy(RpyFromRotation(posture.orientation.toRotationMatrix()), rpy.back()));
    }
    rpy.erase(rpy.begin());
    return rpy;
  }

  /// Limits hold, and nothing is faster or more abrupt than a quick person.
  void ExpectHumanly(const PoseTrajectory& motion) const {
    for (int k = 0; k < motion.num_frames(); ++k) {
      const Posture posture = ModelPosture(model_, motion, k);
      for (int j = 0; j < model_.num_joints(); ++j) {
        ASSERT_GE(posture.joint_angles[j], model_.joint(j).lower) << model_.joint(j).name << k;
        ASSERT_LE(posture.joint_angles[j], model_.joint(j).upper) << model_.joint(j).name << k;
      }
      ASSERT_GT(LowestMarker(motion, k), -0.04) << "frame " << k << " is below the floor";
      if (k == 0) continue;
      const Eigen::VectorXd step = Local(motion.postures[k - 1], motion.postures[k]);
      ASSERT_LT(step.head<3>().norm(), 0.04) << "root faster than 4 m/s in frame " << k;
      ASSERT_LT(step.tail(step.size() - 3).cwiseAbs().maxCoeff(), 0.1) << "10 rad/s in frame " << k;
      if (k == 1) continue;
      const Eigen::VectorXd before = Local(motion.postures[k - 2], motion.postures[k - 1]);
      ASSERT_LT((step - before).cwiseAbs().maxCoeff(), 0.01) << "100 rad/s^2 in frame " << k;
    }
  }

  const KinematicModel model_ =
      ScaleWinter(ReadMmmModel(testing::SourcePath("xml_config/models/mmm.xml")), {1.8, 75, {}});
};

TEST_F(SyntheticMotionTest, HandstandGoesUpsideDownAndBack) {
  const PoseTrajectory motion = MakeHandstand(model_);
  ASSERT_EQ(motion.num_frames(), 675);
  EXPECT_EQ(motion.rate, 100);
  EXPECT_EQ(motion.joint_names, KitJointNames());
  EXPECT_EQ(motion.joint_names.size(), 44U);
  const std::vector<Vector3d> rpy = Rpy(motion);
  double lowest_roll = 0;
  for (const Vector3d& angles : rpy) lowest_roll = std::min(lowest_roll, angles.x());
  EXPECT_NEAR(lowest_roll / kDegree, -183, 0.1);
  EXPECT_NEAR(rpy.front().norm(), 0, 0.02);
  EXPECT_NEAR(rpy.back().norm(), 0, 0.02);
  // Upside down: on the hands, feet above 2 m.
  for (int k = 327; k < 348; ++k) {
    EXPECT_LT(Node(motion, k, "LWx_joint").z(), 0.25);
    EXPECT_LT(Node(motion, k, "RWx_joint").z(), 0.25);
    EXPECT_GT(Node(motion, k, "LFx_joint").z(), 2.0);
    EXPECT_GT(Node(motion, k, "RFx_joint").z(), 2.0);
  }
  ExpectHumanly(motion);
}

TEST_F(SyntheticMotionTest, HandsAndFeetStandStill) {
  const PoseTrajectory motion = MakeHandstand(model_);
  const auto hands = [&](int k) -> Vector3d {
    return (Node(motion, k, "LWx_joint") + Node(motion, k, "RWx_joint")) / 2;
  };
  for (int k = 240; k < 435; k += 15) EXPECT_LT((hands(k) - hands(240)).norm(), 1e-12);
  for (int k = 0; k < 200; k += 15) {
    EXPECT_LT((Node(motion, k, "RFx_joint") - Node(motion, 0, "RFx_joint")).norm(), 1e-12);
    EXPECT_LT((Node(motion, k, "LFx_joint") - Node(motion, 0, "LFx_joint")).norm(), 0.04);
  }
  // Standing, the root is a leg's length above the floor: 0.53 of the height.
  EXPECT_NEAR(motion.postures.front().position.z(), 0.53 * 1.8, 0.02);
}

TEST_F(SyntheticMotionTest, CartwheelTurnsOnceThroughPitch) {
  const PoseTrajectory motion = testing::MakeCartwheel(model_);
  ASSERT_EQ(motion.num_frames(), 400);
  const std::vector<Vector3d> rpy = Rpy(motion);
  EXPECT_NEAR(rpy.front().y(), 0, 0.02);
  EXPECT_NEAR(rpy.back().y(), 360 * kDegree, 0.02);
  for (std::size_t k = 1; k < rpy.size(); ++k) EXPECT_GE(rpy[k].y(), rpy[k - 1].y() - 1e-12);
  EXPECT_GT(motion.postures.back().position.x(), 2);  // to the right
  ExpectHumanly(motion);
}

TEST_F(SyntheticMotionTest, ScaleWithTheModel) {
  const KinematicModel small =
      ScaleWinter(ReadMmmModel(testing::SourcePath("xml_config/models/mmm.xml")), {1.2, 30, {}});
  const Posture a = MakeHandstand(model_).postures[300];
  const Posture b = MakeHandstand(small).postures[300];
  EXPECT_LT((a.position / 1.8 - b.position / 1.2).norm(), 1e-12);
  EXPECT_EQ(a.joint_angles, b.joint_angles);
}

TEST_F(SyntheticMotionTest, AnotherModelIsRefused) {
  ModelDescription description;
  description.segments.emplace_back();
  description.segments[0].name = "box";
  EXPECT_THROW(MakeHandstand(KinematicModel(description)), Error);
}

}  // namespace
}  // namespace mmm_converter
