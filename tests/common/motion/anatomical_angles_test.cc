// SPDX-License-Identifier: MIT
#include "common/motion/anatomical_angles.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <tuple>

#include "common/angles/angle_table.h"
#include "common/io/mmm/mmm_model.h"
#include "common/io/osim/osim_model_reader.h"
#include "common/math/rotation.h"
#include "common/model/coordinate_map.h"
#include "common/model/forward_kinematics.h"
#include "common/model/kit_joints.h"
#include "common/support/error.h"
#include "common/support/units.h"
#include "tests/support/shared_data.h"
#include "tests/support/test_models.h"

namespace mmm_converter {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr double kExact = 1e-9;
constexpr double kTurn = 0.3;  // [rad] within the limits of each joint that is turned

class AnatomicalAnglesTest : public ::testing::Test {
 protected:
  PoseTrajectory Still(const Posture& posture) const { return Motion({posture}); }

  PoseTrajectory Motion(std::vector<Posture> postures) const {
    PoseTrajectory motion;
    motion.rate = 100;
    motion.first_time = 1;
    for (int j = 0; j < model_.num_joints(); ++j) {
      motion.joint_names.push_back(model_.joint(j).name);
    }
    motion.postures = std::move(postures);
    return motion;
  }

  Posture With(const std::string& joint, double angle) const {
    Posture posture = ZeroPosture(model_);
    posture.joint_angles[model_.FindJoint(joint)] = angle;
    return posture;
  }

  static Eigen::Index RowOf(const AnatomicalAngles& angles, const std::string& joint,
                            const std::string& side, const std::string& motion) {
    for (std::size_t i = 0; i < angles.angles.size(); ++i) {
      const AnatomicalAngle& one = angles.angles[i];
      if (one.joint == joint && one.side == side && one.motion == motion) {
        return static_cast<Eigen::Index>(i);
      }
    }
    ADD_FAILURE() << "no " << joint << " " << side << " " << motion;
    return 0;
  }

  double AngleOf(const Posture& posture, const std::string& joint, const std::string& side,
                 const std::string& motion) const {
    const AnatomicalAngles angles = ComputeAnatomicalAngles(model_, Still(posture));
    return angles.values(RowOf(angles, joint, side, motion), 0);
  }

  KinematicModel model_ = ReadMmmModel(testing::SourcePath("xml_config/models/mmm.xml"));
};

TEST_F(AnatomicalAnglesTest, StandingIsZero) {
  const AnatomicalAngles angles = ComputeAnatomicalAngles(model_, Still(ZeroPosture(model_)));
  EXPECT_EQ(angles.angles.size(), 37);
  EXPECT_LT(angles.values.cwiseAbs().maxCoeff(), kExact);
}

TEST_F(AnatomicalAnglesTest, KneesHoldAboutAxesAboutWhichTheyDoNotTurn) {
  const std::vector<HeldAxis> axes = FindHeldAxes(model_);
  ASSERT_EQ(axes.size(), 4);
  const Eigen::Vector3d held(0, 7, 3);  // about forward and up
  const Eigen::MatrixXd moments =
      HeldMoments(model_, Still(ZeroPosture(model_)), axes,
                  std::vector<Eigen::Matrix3Xd>(axes.size(), Eigen::Matrix3Xd(held)));
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const AnatomicalAngle& angle = axes[i].angle;
    EXPECT_STREQ(angle.joint, "knee");
    // A turn about forward takes the foot to the left, one about up its toes: inwards on the right.
    const double inwards = std::string(angle.side) == "right" ? 1 : -1;
    const bool is_adduction = std::string(angle.motion) == "adduction";
    EXPECT_TRUE(is_adduction || std::string(angle.motion) == "internal rotation");
    EXPECT_NEAR(moments(static_cast<Eigen::Index>(i), 0), inwards * (is_adduction ? 7 : 3), kExact);
  }
}

// What a posture looks like, and what its angle is called: p is where a segment is, and which way
// it has gone from where it is in the posture that is all zero (x right, y forward, z up).
struct Look {
  const char* model_joint;
  double turn;
  const char* segment;
  Eigen::Vector3d way;
  const char* joint;
  const char* side;
  const char* motion;
  double sign;
};

const Look kLooks[] = {
    {"LHx_joint", kTurn, "LAx_joint", {0, 1, 0}, "hip", "left", "flexion", 1},
    {"RHx_joint", kTurn, "RAx_joint", {0, 1, 0}, "hip", "right", "flexion", 1},
    {"LHy_joint", kTurn, "LAx_joint", {1, 0, 0}, "hip", "left", "adduction", 1},
    {"RHy_joint", kTurn, "RAx_joint", {-1, 0, 0}, "hip", "right", "adduction", 1},
    {"LHz_joint", kTurn, "LFx_joint", {1, 0, 0}, "hip", "left", "internal rotation", 1},
    {"RHz_joint", kTurn, "RFx_joint", {-1, 0, 0}, "hip", "right", "internal rotation", 1},
    {"LKx_joint", -kTurn, "LAx_joint", {0, -1, 0}, "knee", "left", "flexion", 1},
    {"RAx_joint", kTurn, "RFx_joint", {0, 0, 1}, "ankle", "right", "dorsiflexion", 1},
    {"LEx_joint", kTurn, "LWx_joint", {0, 1, 0}, "elbow", "left", "flexion", 1},
    {"RSx_joint", kTurn, "REx_joint", {0, 1, 0}, "shoulder", "right", "flexion", 1},
    {"LSy_joint", kTurn, "LEx_joint", {-1, 0, 0}, "shoulder", "left", "adduction", -1},
    {"BTx_joint", kTurn, "BUNx_joint", {0, 1, 0}, "trunk", "", "flexion", 1},
    {"BTy_joint", kTurn, "BUNx_joint", {1, 0, 0}, "trunk", "", "lateral bending", 1}};

TEST_F(AnatomicalAnglesTest, IsCalledAsItLooks) {
  const auto standing = SegmentPoses(model_, ZeroPosture(model_));
  for (const Look& look : kLooks) {
    const int segment = model_.FindSegment(look.segment);
    ASSERT_GE(segment, 0) << look.segment;
    // Whichever sign of the joint moves the segment that way.
    double turn = look.turn;
    const auto moved = [&](double q) -> double {
      const auto X_WS = SegmentPoses(model_, With(look.model_joint, q));
      return (X_WS[segment].translation() - standing[segment].translation()).dot(look.way);
    };
    if (moved(turn) < 0) turn = -turn;
    ASSERT_GT(moved(turn), 0.01) << look.model_joint;
    EXPECT_NEAR(AngleOf(With(look.model_joint, turn), look.joint, look.side, look.motion),
                look.sign * kTurn, kExact)
        << look.model_joint;
  }
}

TEST_F(AnatomicalAnglesTest, PelvisAgainstTheLaboratory) {
  // R = Rz(rotation) Rx(obliquity) Ry(tilt) of forward, left and up: MMM's y, -x and z.
  const double rotation = 2, obliquity = 0.2, tilt = 0.4;
  Posture posture = ZeroPosture(model_);
  posture.orientation = Eigen::AngleAxisd(rotation, Eigen::Vector3d::UnitZ()) *
                        Eigen::AngleAxisd(obliquity, Eigen::Vector3d::UnitY()) *
                        Eigen::AngleAxisd(tilt, -Eigen::Vector3d::UnitX());
  EXPECT_NEAR(AngleOf(posture, "pelvis", "", "rotation"), rotation, kExact);
  EXPECT_NEAR(AngleOf(posture, "pelvis", "", "obliquity"), obliquity, kExact);
  EXPECT_NEAR(AngleOf(posture, "pelvis", "", "tilt"), tilt, kExact);
}

TEST_F(AnatomicalAnglesTest, MirroredPosturesHaveTheSameAngles) {
  Posture left = ZeroPosture(model_), right = left;
  for (const auto& [name, angle, is_mirrored] :
       {std::tuple{"Hx", 0.5, false}, std::tuple{"Hy", 0.2, true}, std::tuple{"Hz", 0.3, true},
        std::tuple{"Kx", -0.7, false}, std::tuple{"Ax", 0.2, false}, std::tuple{"Az", 0.1, true},
        std::tuple{"Ex", 0.9, false}, std::tuple{"Ez", 0.4, true}, std::tuple{"Wy", 0.3, true}}) {
    left.joint_angles[model_.FindJoint(std::string("L") + name + "_joint")] = angle;
    right.joint_angles[model_.FindJoint(std::string("R") + name + "_joint")] =
        is_mirrored ? -angle : angle;
  }
  const AnatomicalAngles of_left = ComputeAnatomicalAngles(model_, Still(left));
  const AnatomicalAngles of_right = ComputeAnatomicalAngles(model_, Still(right));
  for (std::size_t i = 0; i < of_left.angles.size(); ++i) {
    const AnatomicalAngle& one = of_left.angles[i];
    if (std::string(one.side) != "left") continue;
    EXPECT_NEAR(of_left.values(static_cast<Eigen::Index>(i), 0),
                of_right.values(RowOf(of_right, one.joint, "right", one.motion), 0), kExact)
        << one.joint << " " << one.motion;
  }
}

TEST_F(AnatomicalAnglesTest, TurnsWithoutJumps) {
  std::vector<Posture> postures;
  constexpr int kFrames = 200;
  for (int k = 0; k < kFrames; ++k) {
    Posture posture = ZeroPosture(model_);
    posture.orientation = Exp({0, 0, 4 * std::numbers::pi * k / (kFrames - 1)});
    postures.push_back(posture);
  }
  const AnatomicalAngles angles = ComputeAnatomicalAngles(model_, Motion(postures));
  EXPECT_NEAR(angles.values(RowOf(angles, "pelvis", "", "rotation"), kFrames - 1),
              4 * std::numbers::pi, kExact);
}

// Raised to the side by 150 degrees and lowered again, with the elbow a little in front.
TEST_F(AnatomicalAnglesTest, AnArmThatHangsAgainHangsAtZero) {
  const std::string side = "left";
  std::vector<Posture> postures;
  constexpr int kFrames = 101;
  for (int k = 0; k < kFrames; ++k) {
    const double raised = std::sin(std::numbers::pi * k / (kFrames - 1)) * 150 / kDegrees;
    Posture posture = ZeroPosture(model_);
    posture.joint_angles[model_.FindJoint("LSy_joint")] = raised;
    posture.joint_angles[model_.FindJoint("LSx_joint")] = 0.05 * (k < kFrames / 2 ? 1 : -1);
    postures.push_back(posture);
  }
  const AnatomicalAngles angles = ComputeAnatomicalAngles(model_, Motion(postures));
  const auto last = [&](const char* motion) {
    return angles.values(RowOf(angles, "shoulder", side, motion), kFrames - 1);
  };
  EXPECT_NEAR(last("flexion"), 0, 0.1);
  EXPECT_NEAR(last("adduction"), 0, 0.1);
  const Eigen::RowVectorXd adduction =
      angles.values.row(RowOf(angles, "shoulder", side, "adduction"));
  EXPECT_NEAR(adduction.cwiseAbs().maxCoeff(), 150 / kDegrees, 0.1);
}

// What the lower spine bends too much the upper one bends too little: the trunk is surer than both.
TEST_F(AnatomicalAnglesTest, ErrorsThatHangTogetherCancel) {
  PoseTrajectory motion = Motion({ZeroPosture(model_), ZeroPosture(model_)});
  const Eigen::Index rows = 6 + model_.num_joints();
  motion.standard_deviations.setConstant(rows, 2, 0.1);
  const auto deviation = [&](int frame) {
    const AnatomicalAngles angles = ComputeAnatomicalAngles(model_, motion);
    return angles.deviations(RowOf(angles, "trunk", "", "flexion"), frame);
  };
  EXPECT_NEAR(deviation(0), 0.1 * std::sqrt(2), 1e-8);
  Eigen::MatrixXd correlation = Eigen::MatrixXd::Identity(rows, rows);
  const int lower = 6 + model_.FindJoint("BPx_joint"), upper = 6 + model_.FindJoint("BTx_joint");
  correlation(lower, upper) = correlation(upper, lower) = -0.5;
  motion.correlations = {{motion.time(0), Eigen::MatrixXd::Identity(rows, rows)},
                         {motion.time(1), correlation}};
  EXPECT_NEAR(deviation(0), 0.1 * std::sqrt(2), 1e-8);
  EXPECT_NEAR(deviation(1), 0.1, 1e-8);
}

TEST_F(AnatomicalAnglesTest, DeviationsAreThoseOfTheJointsTurned) {
  Posture posture = With("LHx_joint", 0.6);
  posture.joint_angles[model_.FindJoint("LHy_joint")] = 0.2;
  posture.joint_angles[model_.FindJoint("LHz_joint")] = -0.3;
  PoseTrajectory motion = Still(posture);
  motion.standard_deviations.setConstant(6 + model_.num_joints(), 1, 0.01);
  const AnatomicalAngles angles = ComputeAnatomicalAngles(model_, motion);
  // One joint alone: its own. Three: by differences of the whole.
  EXPECT_NEAR(angles.deviations(RowOf(angles, "knee", "left", "flexion"), 0), 0.01, 1e-8);
  for (const char* name : {"flexion", "adduction", "internal rotation"}) {
    double square = 0;
    for (const char* joint : {"LHx_joint", "LHy_joint", "LHz_joint"}) {
      constexpr double kStep = 1e-6;
      Posture more = posture, less = posture;
      more.joint_angles[model_.FindJoint(joint)] += kStep;
      less.joint_angles[model_.FindJoint(joint)] -= kStep;
      const double slope =
          (AngleOf(more, "hip", "left", name) - AngleOf(less, "hip", "left", name)) / (2 * kStep);
      square += slope * slope;
    }
    EXPECT_NEAR(angles.deviations(RowOf(angles, "hip", "left", name), 0), 0.01 * std::sqrt(square),
                1e-8)
        << name;
  }
}

TEST_F(AnatomicalAnglesTest, MomentsHaveThePowerOfTheJoints) {
  Posture posture = With("LHx_joint", 0.6);
  posture.joint_angles[model_.FindJoint("LHy_joint")] = 0.2;
  posture.joint_angles[model_.FindJoint("LHz_joint")] = -0.3;
  Eigen::VectorXd forces = Eigen::VectorXd::Zero(model_.num_joints());
  Posture before = posture, after = posture;
  constexpr double kStep = 1e-5;  // [s] from before to after: 2
  double power = 0;
  for (const auto& [name, force, rate] :
       {std::tuple("LHx_joint", 40.0, 1.0), {"LHy_joint", -25.0, 2.0}, {"LHz_joint", 8.0, -3.0}}) {
    const int joint = model_.FindJoint(name);
    forces[joint] = force;
    power += force * rate;
    before.joint_angles[joint] -= kStep * rate;
    after.joint_angles[joint] += kStep * rate;
  }
  const AnatomicalAngles angles = ComputeAnatomicalAngles(model_, Motion({before, after}));
  forces[model_.FindJoint("RKx_joint")] = std::nan("");
  forces[model_.FindJoint("LKx_joint")] = 30;
  const Eigen::VectorXd moments = AnatomicalMoments(model_, Still(posture), forces);
  double power_of_moments = 0;
  for (const char* motion : {"flexion", "adduction", "internal rotation"}) {
    const Eigen::Index row = RowOf(angles, "hip", "left", motion);
    power_of_moments +=
        moments[row] * (angles.values(row, 1) - angles.values(row, 0)) / (2 * kStep);
  }
  EXPECT_NEAR(power_of_moments, power, 1e-6);
  // MMM's knees bend to negative angles.
  EXPECT_NEAR(moments[RowOf(angles, "knee", "left", "flexion")], -30, kExact * 1e3);
  EXPECT_TRUE(std::isnan(moments[RowOf(angles, "knee", "right", "flexion")]));
  EXPECT_TRUE(std::isnan(moments[RowOf(angles, "pelvis", "", "tilt")]));
}

TEST_F(AnatomicalAnglesTest, OpenSimsCoordinatesOfHipKneeAndPelvis) {
  const KinematicModel model = ReadOsimModel(testing::SourcePath("examples/opensim/generic.osim"));
  const auto& coordinates = model.coordinates()->coordinates();
  Eigen::VectorXd values = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(coordinates.size()));
  const auto set = [&](const std::string& name, double value) {
    for (std::size_t i = 0; i < coordinates.size(); ++i) {
      if (coordinates[i].name == name) values[static_cast<Eigen::Index>(i)] = value;
    }
  };
  set("hip_flexion_r", 0.5);
  set("hip_adduction_r", 0.1);
  set("hip_rotation_r", -0.2);
  set("hip_adduction_l", 0.3);
  set("knee_angle_l", -0.8);
  set("lumbar_extension", -0.25);
  PoseTrajectory motion;
  motion.rate = 100;
  for (int j = 0; j < model.num_joints(); ++j) motion.joint_names.push_back(model.joint(j).name);
  motion.postures = {PostureOf(model, values)};
  const AnatomicalAngles angles = ComputeAnatomicalAngles(model, motion);
  const auto angle = [&](const char* joint, const char* side, const char* name) {
    return angles.values(RowOf(angles, joint, side, name), 0);
  };
  EXPECT_NEAR(angle("hip", "right", "flexion"), 0.5, kExact);
  EXPECT_NEAR(angle("hip", "right", "adduction"), 0.1, kExact);
  EXPECT_NEAR(angle("hip", "right", "internal rotation"), -0.2, kExact);
  EXPECT_NEAR(angle("hip", "left", "adduction"), 0.3, kExact);
  EXPECT_NEAR(angle("knee", "left", "flexion"), 0.8, kExact);
  EXPECT_NEAR(angle("trunk", "", "flexion"), 0.25, kExact);
}

TEST_F(AnatomicalAnglesTest, ARowForEachFrameAndAngle) {
  PoseTrajectory motion = Motion({With("LEx_joint", 0.5), With("LEx_joint", 0.6)});
  const AnatomicalAngles without = ComputeAnatomicalAngles(model_, motion);
  std::string text;
  FormatAngleCsv(without)([&](std::string_view piece) { text += piece; });
  EXPECT_THAT(text, StartsWith("time_s,joint,side,angle,degrees,sd_degrees\n1,pelvis,,tilt,0,\n"));
  EXPECT_THAT(text, HasSubstr("\n1.01,elbow,left,flexion,34.377468,\n"));
  motion.standard_deviations.setConstant(6 + model_.num_joints(), 2, std::numbers::pi / 180);
  const AnatomicalAngles with = ComputeAnatomicalAngles(model_, motion);
  text.clear();
  FormatAngleCsv(with)([&](std::string_view piece) { text += piece; });
  EXPECT_THAT(text, HasSubstr("\n1,elbow,left,flexion,28.64789,1\n"));
}

TEST_F(AnatomicalAnglesTest, EachSideSeesThePelvisItsOwnWay) {
  PoseTrajectory motion = Motion({With("LEx_joint", 0)});
  motion.postures[0].orientation = Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitZ()) *
                                   Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitY());
  const AnatomicalAngles angles = ComputeAnatomicalAngles(model_, motion);
  std::string text;
  FormatAngleCsv(angles)([&](std::string_view piece) { text += piece; });
  EXPECT_THAT(text,
              HasSubstr("\n1,pelvis,,obliquity,11.459156,\n1,pelvis,left,obliquity,11.459156,\n"
                        "1,pelvis,right,obliquity,-11.459156,\n1,pelvis,,rotation,5.729578,\n"
                        "1,pelvis,left,rotation,-5.729578,\n1,pelvis,right,rotation,5.729578,\n"));
}

TEST_F(AnatomicalAnglesTest, OtherModelsHaveNone) {
  const KinematicModel model = testing::MakeBranchedModel();
  EXPECT_FALSE(HasAnatomy(model));
  PoseTrajectory motion;
  motion.rate = 100;
  EXPECT_THROW(ComputeAnatomicalAngles(model, motion), Error);
}

}  // namespace
}  // namespace mmm_converter
