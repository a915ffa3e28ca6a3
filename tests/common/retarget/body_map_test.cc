// SPDX-License-Identifier: MIT
#include "common/retarget/body_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <regex>
#include <vector>

#include "common/io/urdf/urdf_robot.h"
#include "common/retarget/foot_figures.h"
#include "common/retarget/limb_chains.h"
#include "common/retarget/robot_body.h"
#include "common/support/atomic_file.h"
#include "common/support/error.h"
#include "tests/common/retarget/biped.h"
#include "tests/support/test_folder.h"

namespace mmm_converter {
namespace {

using testing::BipedShape;
using ::testing::HasSubstr;
using testing::MakeBiped;
using testing::TestFolder;

std::string RefusalOf(const BipedShape& shape, const BodyMapChoice& choice = {}) {
  try {
    FindBodyMap(MakeBiped(shape).model, choice);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

std::string NameOf(const Robot& robot, const std::optional<LimbMap>& limb) {
  return robot.model.segments()[limb->chain[limb->fold]].name;
}

TEST(BodyMapTest, FindsLimbsWithTheirLengths) {
  const Robot robot = MakeBiped({});
  const BodyMap map = FindBodyMap(robot.model, {});
  EXPECT_EQ(NameOf(robot, map.leg(Side::kLeft)), "left_knee");
  EXPECT_EQ(NameOf(robot, map.leg(Side::kRight)), "right_knee");
  EXPECT_EQ(NameOf(robot, map.arm(Side::kLeft)), "left_elbow");
  EXPECT_NEAR(map.legs[0]->upper.length, 0.36, 1e-9);
  EXPECT_NEAR(map.legs[0]->lower.length, 0.36, 1e-9);
  EXPECT_NEAR(map.arms[1]->upper.length, 0.25, 1e-9);
  EXPECT_NEAR(map.arms[1]->lower.length, 0.22, 1e-9);
  EXPECT_TRUE(map.R_WA.isApprox(Eigen::Matrix3d::Identity(), 1e-9));
  EXPECT_EQ(robot.model.segments()[map.chest].name, "waist");
}

TEST(BodyMapTest, LimbAxesPointToTheProximalCentreAndLeft) {
  const BodyMap map = FindBodyMap(MakeBiped({}).model, {});
  for (const auto* limb : {&map.legs[0], &map.legs[1], &map.arms[0], &map.arms[1]}) {
    EXPECT_TRUE((*limb)->upper.R_SL.isApprox(Eigen::Matrix3d::Identity(), 1e-9));
    EXPECT_TRUE((*limb)->lower.R_SL.isApprox(Eigen::Matrix3d::Identity(), 1e-9));
  }
}

TEST(BodyMapTest, WithoutSidesInNamesTheFoldsDecide) {
  BipedShape shape;
  shape.sides = {"a_", "b_"};
  const Robot forward = MakeBiped(shape);
  EXPECT_EQ(NameOf(forward, FindBodyMap(forward.model, {}).leg(Side::kLeft)), "a_knee");
  shape.knee_lower = -2.4;
  shape.knee_upper = 0;
  shape.elbow_lower = 0;
  shape.elbow_upper = 2.4;
  const Robot backward = MakeBiped(shape);
  const BodyMap map = FindBodyMap(backward.model, {});
  EXPECT_EQ(NameOf(backward, map.leg(Side::kLeft)), "b_knee");
  EXPECT_NEAR(map.R_WA(0, 0), -1, 1e-9);
}

TEST(BodyMapTest, ExchangedNamesAreRefused) {
  BipedShape shape;
  shape.sides = {"right_", "left_"};
  EXPECT_THAT(RefusalOf(shape), HasSubstr("contradict"));
  EXPECT_THAT(RefusalOf(shape), HasSubstr("knee"));
}

TEST(BodyMapTest, ElbowsAgainstKneesAreRefused) {
  BipedShape shape;
  shape.sides = {"a_", "b_"};
  shape.elbow_lower = 0;
  shape.elbow_upper = 2.4;
  EXPECT_THAT(RefusalOf(shape), HasSubstr("a_elbow"));
}

TEST(BodyMapTest, LimitsThatSayNothingAreRefusedUnlessNamesOrAMapDecide) {
  BipedShape shape;
  shape.knee_lower = shape.elbow_lower = -3.14;
  shape.knee_upper = shape.elbow_upper = 3.14;
  EXPECT_EQ(RefusalOf(shape), "");
  shape.sides = {"a_", "b_"};
  EXPECT_THAT(RefusalOf(shape), HasSubstr("a_knee"));
  BodyMapChoice choice;
  choice.forward = -Eigen::Vector3d::UnitX();
  EXPECT_EQ(RefusalOf(shape, choice), "");
  const Robot robot = MakeBiped(shape);
  EXPECT_EQ(NameOf(robot, FindBodyMap(robot.model, choice).leg(Side::kLeft)), "b_knee");
}

TEST(BodyMapTest, OriginsMayLieAnywhereAlongTheirAxes) {
  BipedShape shape;
  shape.slip = 0.24;
  const Robot robot = MakeBiped(shape);
  const BodyMap map = FindBodyMap(robot.model, {});
  ASSERT_TRUE(map.has_legs());
  EXPECT_EQ(NameOf(robot, map.leg(Side::kLeft)), "left_knee");
  EXPECT_EQ(NameOf(robot, map.arm(Side::kRight)), "right_elbow");
  for (const auto& leg : map.legs) EXPECT_NEAR(leg->upper.length, 0.36, 1e-9);
  for (const auto& arm : map.arms) EXPECT_NEAR(arm->upper.length, 0.25, 1e-9);
}

TEST(BodyMapTest, ClaviclesAreNoUpperArms) {
  BipedShape shape;
  shape.has_clavicles = true;
  const Robot robot = MakeBiped(shape);
  const BodyMap map = FindBodyMap(robot.model, {});
  EXPECT_EQ(NameOf(robot, map.arm(Side::kLeft)), "left_elbow");
  EXPECT_NEAR(map.arms[0]->upper.length, 0.25, 1e-9);
}

TEST(BodyMapTest, LegsThatAreNoImagesAreRefusedNotLeftOut) {
  BipedShape shape;
  shape.right_thigh = 0.3;
  EXPECT_THAT(RefusalOf(shape), HasSubstr("left_knee"));
  EXPECT_THAT(RefusalOf(shape), HasSubstr("named as legs"));
  shape.right_thigh = 0.352;  // as of people
  EXPECT_EQ(RefusalOf(shape), "");
}

TEST(BodyMapTest, AKneeOfTwoJointsThatTurnAsOneIsOneKnee) {
  for (const double gap : {0.0, 0.04}) {
    for (const bool reversed : {false, true}) {
      BipedShape shape;
      shape.halves = gap;
      shape.halves_reversed = reversed;
      const Robot robot = MakeBiped(shape);
      const BodyMap map = FindBodyMap(robot.model, {});
      for (const auto* limb : {&map.legs[0], &map.legs[1], &map.arms[0], &map.arms[1]}) {
        const bool is_leg = limb == &map.legs[0] || limb == &map.legs[1];
        EXPECT_EQ(NameOf(robot, *limb).substr(NameOf(robot, *limb).size() - 5), "_half");
        EXPECT_EQ((*limb)->lower.segment, (*limb)->chain[(*limb)->fold + 1]);
        EXPECT_NEAR((*limb)->lower.length, is_leg ? 0.36 : 0.22, 1e-9);
        EXPECT_NEAR((*limb)->length(), (is_leg ? 0.72 : 0.47) + gap, 1e-9);
      }
      EXPECT_TRUE((*FindRobotBody(robot, {}, {}).feet)[0].rolls);
    }
  }
}

TEST(BodyMapTest, HandsAndToesEndTheirChains) {
  BipedShape shape;
  shape.has_fingers = shape.has_toes = true;
  shape.palm = 0.3;
  const Robot robot = MakeBiped(shape);
  const BodyMap map = FindBodyMap(robot.model, {});
  EXPECT_EQ(robot.model.segments()[map.arms[0]->end].name, "left_wrist");
  EXPECT_EQ(robot.model.segments()[map.legs[0]->end].name, "left_ankle_roll");
}

TEST(BodyMapTest, AnElbowWithTwoAxesFoldsAcross) {
  BipedShape shape;
  shape.elbow_bends_twice = true;
  const Robot robot = MakeBiped(shape);
  EXPECT_EQ(NameOf(robot, FindBodyMap(robot.model, {}).arm(Side::kLeft)), "left_elbow");
}

TEST(BodyMapTest, ElbowsWithoutLimitsMayFoldAside) {
  BipedShape shape;
  shape.elbow_axis = "1 0 0";
  shape.elbow_lower = -3.14;
  shape.elbow_upper = 3.14;
  const Robot robot = MakeBiped(shape);
  const BodyMap map = FindBodyMap(robot.model, {});
  EXPECT_EQ(NameOf(robot, map.arm(Side::kLeft)), "left_elbow");
  // Images of each other: y is along the axis, to the other side of it.
  EXPECT_NEAR(map.arms[0]->lower.R_SL(0, 1), -map.arms[1]->lower.R_SL(0, 1), 1e-9);
}

TEST(BodyMapTest, ARobotWhoseFileHasYUpStands) {
  EXPECT_TRUE(FindStanding(MakeBiped({}).model).isApprox(Eigen::Quaterniond::Identity()));
  const Eigen::Quaterniond standing(Eigen::AngleAxisd(EIGEN_PI / 2, Eigen::Vector3d::UnitX()));
  ModelDescription lying = DescriptionOf(MakeBiped({}).model);
  for (Segment& segment : lying.segments) {
    if (segment.parent == 0) segment.X_PF = standing.inverse() * segment.X_PF;
  }
  const KinematicModel model(lying);
  EXPECT_TRUE(FindStanding(model).isApprox(standing, 1e-9));
  lying.standing = standing;
  const BodyMap map = FindBodyMap(KinematicModel(lying), {});
  EXPECT_NEAR(map.legs[0]->upper.length, 0.36, 1e-9);
  EXPECT_TRUE(map.R_WA.isApprox(Eigen::Matrix3d::Identity(), 1e-9));
}

TEST(BodyMapTest, AFixedTrunkHasArmsAlone) {
  BipedShape shape;
  shape.has_legs = false;
  const BodyMap map = FindBodyMap(MakeBiped(shape).model, {});
  EXPECT_FALSE(map.has_legs());
  EXPECT_TRUE(map.has_arms());
}

TEST(BodyMapTest, LegsThatCannotWalkAreRefused) {
  ModelDescription fixed = DescriptionOf(MakeBiped({}).model);
  fixed.is_root_fixed = true;
  try {
    FindBodyMap(KinematicModel(fixed), {});
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("<freejoint/>"));
  }
}

TEST(BodyMapTest, AMapFileDecides) {
  const std::string file = TestFolder() + "/map.xml";
  WriteFileAtomically(file, std::string(R"(<BodyMap forward="1 0 0">
<Limb name="left arm" first="left_shoulder_pitch" fold="left_elbow" last="left_elbow"/>
<Limb name="right arm" first="right_shoulder_pitch" fold="right_elbow" last="right_elbow"/>
</BodyMap>)"));
  const BodyMap map = FindBodyMap(MakeBiped({}).model, ReadBodyMapChoice(file));
  EXPECT_FALSE(map.has_legs());
  EXPECT_NEAR(map.arms[0]->upper.length, 0.25, 1e-9);
  WriteFileAtomically(file, std::string(R"(<BodyMap>
<Limb name="left arm" first="left_shoulder_pitch" fold="left_elbow" last="left_elbow"/>
<Limb name="right arm" first="left_shoulder_roll" fold="left_elbow" last="left_elbow"/>
</BodyMap>)"));
  EXPECT_THROW(FindBodyMap(MakeBiped({}).model, ReadBodyMapChoice(file)), Error);
  WriteFileAtomically(file, std::string(R"(<BodyMap><Limb name="left leg" first="a" last="b"/>
<Limb name="left leg" first="a" last="b"/></BodyMap>)"));
  EXPECT_THROW(ReadBodyMapChoice(file), Error);
  WriteFileAtomically(file, std::string(R"(<BodyMap><Limb name="tail" first="a" last="b"/>
<Leg/></BodyMap>)"));
  try {
    ReadBodyMapChoice(file);
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("map.xml:1: <Limb name=\"tail\">"));
    EXPECT_THAT(error.what(), HasSubstr("map.xml:2: <Leg>"));
  }
}

TEST(SideByNamesTest, OneLetterOrWordTells) {
  EXPECT_EQ(SideByNames("left_knee", "right_knee"), 1);
  EXPECT_EQ(SideByNames("R_Elbow", "L_Elbow"), -1);
  EXPECT_EQ(SideByNames("leg_l1_joint", "leg_r1_joint"), 1);
  EXPECT_EQ(SideByNames("J03_KNEE_L", "J09_KNEE_R"), 1);
  EXPECT_EQ(SideByNames("a_knee", "b_knee"), 0);
  EXPECT_EQ(SideByNames("left_knee", "right_hip"), 0);
}

TEST(RobotBodyTest, TheSoleIsFoundOrAskedFor) {
  const RobotBody body = FindRobotBody(MakeBiped({}), {}, {});
  EXPECT_NEAR(body.size, 0.8, 1e-9);
  EXPECT_NEAR(body.hip_width, 0.2, 1e-9);
  const RobotFoot& foot = (*body.feet)[0];
  EXPECT_TRUE(foot.toe.isApprox(Eigen::Vector3d(0.14, 0, -0.08), 1e-9));
  EXPECT_TRUE(foot.heel.isApprox(Eigen::Vector3d(-0.06, 0, -0.08), 1e-9));
  BipedShape shape;
  shape.has_sole = false;
  EXPECT_THROW(FindRobotBody(MakeBiped(shape), {}, {}), Error);
  EXPECT_NEAR(FindRobotBody(MakeBiped(shape), {}, {0.1}).size, 0.82, 1e-9);
  for (const double none : {-0.1, 7.0, std::nan("")}) {
    EXPECT_THROW(FindRobotBody(MakeBiped(shape), {}, {none}), Error) << none;
  }
}

TEST(RobotBodyTest, AGivenSoleIsABoxThatIsDoubted) {
  BipedShape shape;
  shape.has_sole = false;
  const SoleChoice choice = {0.08, Eigen::Vector2d(0.2, 0.08)};
  const RobotFoot foot = (*FindRobotBody(MakeBiped(shape), {}, choice).feet)[0];
  EXPECT_TRUE(foot.toe.isApprox(Eigen::Vector3d(0.12, 0, -0.08), 1e-9));  // its mass is at 0.02
  EXPECT_TRUE(foot.heel.isApprox(Eigen::Vector3d(-0.08, 0, -0.08), 1e-9));
  EXPECT_NEAR(foot.width, 0.08, 1e-9);
  EXPECT_THAT(foot.doubt, HasSubstr("as given"));
  EXPECT_THAT((*FindRobotBody(MakeBiped(shape), {}, {0.08}).feet)[0].doubt,
              HasSubstr("place only"));
  EXPECT_EQ((*FindRobotBody(MakeBiped({}), {}, {}).feet)[0].doubt, "");
  EXPECT_THROW(FindRobotBody(MakeBiped(shape), {}, {0.08, Eigen::Vector2d(200, 80)}), Error);
}

TEST(RobotBodyTest, AMeshOfARoundSoleBearsOnFewPoints) {
  BipedShape shape;
  shape.has_sole = false;
  Robot robot = MakeBiped(shape);
  for (const char* ankle : {"left_ankle_roll", "right_ankle_roll"}) {
    RobotMesh& mesh = robot.meshes.emplace_back();
    mesh.segment = robot.model.FindSegment(ankle);
    for (int i = 0; i <= 40; ++i) {  // a cylinder across, of which the foot rolls
      const double angle = EIGEN_PI * i / 40;
      for (const double y : {-0.04, 0.04}) {
        mesh.hull.emplace_back(0.1 * std::cos(angle), y, -0.02 - 0.06 * std::sin(angle));
      }
    }
  }
  const RobotFoot foot = (*FindRobotBody(robot, {}, {}).feet)[0];
  EXPECT_EQ(foot.said, "1 mesh of left_ankle_roll_link");
  EXPECT_LE(foot.balls.size(), 32U);
  for (const double pitch : {-0.9, -0.3, 0.0, 0.2, 0.6, 0.9}) {
    const Eigen::Isometry3d X = StandingFoot(foot, {0, 0}, 0, pitch, 0);
    double lowest = 1;
    for (const FloorBall& ball : foot.balls) lowest = std::min(lowest, (X * ball.p_S).z());
    EXPECT_NEAR(LowestOf(foot, X), 0, 1e-12) << pitch;
    EXPECT_LT(lowest, 0.001) << pitch;  // kHullTolerance, between its directions a little more
  }
}

TEST(RobotBodyTest, ARobotInCentimetresIsTold) {
  Robot robot = MakeBiped({});
  ModelDescription large = DescriptionOf(robot.model);
  for (Segment& segment : large.segments) {
    segment.X_PF.translation() *= 100;
    segment.p_SB *= 100;
  }
  robot.model = KinematicModel(std::move(large));
  try {
    FindRobotBody(robot, {}, {0.1});
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("centimetres"));
  }
}

// As Onshape's exports are.
TEST(BodyMapTest, JointsWithoutLimitsAreMappedByTheirAxesAndNames) {
  const std::string limits =
      std::regex_replace(testing::BipedText({}), std::regex(R"((lower|upper)="[-.0-9]*")"), "");
  const Robot bare = ParseUrdfRobot(limits, "biped.urdf");
  ASSERT_EQ(bare.model.num_joints(), 21);
  const BodyMap known = FindBodyMap(MakeBiped({}).model, {}), map = FindBodyMap(bare.model, {});
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(map.legs[i]->chain, known.legs[i]->chain);
    EXPECT_EQ(map.legs[i]->fold, known.legs[i]->fold);
    EXPECT_EQ(map.arms[i]->fold, known.arms[i]->fold);
  }
  EXPECT_TRUE(map.R_WA.isApprox(known.R_WA, 1e-9));
}

TEST(RobotBodyTest, ALegIsAsLongWhateverAnAnglesZeroIs) {
  for (const double zero : {0.35, -0.2, 0.02}) {
    BipedShape shape;
    shape.ankle_zero = zero;
    const RobotBody body = FindRobotBody(MakeBiped(shape), {}, {});
    const RobotFoot& foot = (*body.feet)[0];
    EXPECT_NEAR(body.size, 0.8, std::abs(zero) < 0.05 ? 0.004 : 1e-5) << zero;
    EXPECT_NEAR(foot.ankle_height, 0.08, std::abs(zero) < 0.05 ? 0.004 : 1e-5) << zero;
    if (std::abs(zero) < 0.05) continue;  // as files round
    EXPECT_TRUE(foot.R_FA.isApprox(Eigen::Matrix3d::Identity(), 1e-5)) << zero;
    EXPECT_NEAR((foot.toe - foot.heel).norm(), 0.2, 1e-5) << zero;
  }
}

TEST(RobotBodyTest, ToesBelongToTheSole) {
  BipedShape shape;
  shape.has_toes = true;
  const RobotFoot foot = (*FindRobotBody(MakeBiped(shape), {}, {}).feet)[0];
  EXPECT_NEAR(foot.heel.x(), -0.06, 1e-9);
  EXPECT_NEAR(foot.toe.x(), 0.22, 1e-9);
}

TEST(RobotBodyTest, AKneeThatIsTiedToItsHipIsRefused) {
  Robot robot = MakeBiped({});
  const auto segment = [&](const char* name) { return robot.model.FindSegment(name); };
  robot.ties = {{segment("left_knee"), segment("left_ankle_roll")}};  // ankles have rods
  FindRobotMap(robot, {});
  robot.ties = {{segment("left_hip_roll"), segment("left_ankle_pitch")}};
  try {
    FindRobotMap(robot, {});
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("left_knee"));
  }
}

TEST(RobotBodyTest, AStandingFootTouchesTheFloorAndTurnsAboutItsEdges) {
  const RobotFoot foot = (*FindRobotBody(MakeBiped({}), {}, {}).feet)[1];
  for (const double pitch : {-0.4, 0.0, 0.3, 0.9}) {
    const Eigen::Isometry3d X = StandingFoot(foot, {1, 2}, 0.5, pitch, 0);
    EXPECT_NEAR(LowestOf(foot, X), 0, 1e-12);
    const Eigen::Vector3d edge = pitch > 0 ? foot.toe : foot.heel;
    const Eigen::Vector3d flat = StandingFoot(foot, {1, 2}, 0.5, 0, 0) * edge;
    EXPECT_TRUE((X * edge).isApprox(flat, 1e-9)) << pitch;
    for (const double roll : {-0.2, 0.3}) {
      const Eigen::Isometry3d rolled = StandingFoot(foot, {1, 2}, 0.5, pitch, roll);
      EXPECT_NEAR(LowestOf(foot, rolled), 0, 1e-12) << pitch << " " << roll;
    }
  }
}

TEST(RobotBodyTest, AFootThatLeansComesDownAndRisesWithoutSliding) {
  const RobotFoot foot = (*FindRobotBody(MakeBiped({}), {}, {}).feet)[1];
  struct Turn {
    Eigen::Vector2d from, to;  // pitch and roll [rad]
  };
  constexpr int kSteps = 500;
  for (const Turn& turn : std::vector<Turn>{{{-0.3, 0.25}, {0, 0.25}},    // a heel comes down
                                            {{0, -0.25}, {0.5, -0.25}},   // a heel goes up
                                            {{0, -0.25}, {0, 0.25}},      // over to the other side
                                            {{0.4, 0.25}, {0.4, -0.25}},  // on the toes
                                            {{-0.3, 0}, {-0.3, 0.25}}}) {
    double most = 0;
    Eigen::Isometry3d before = StandingFoot(foot, {1, 2}, 0.5, turn.from[0], turn.from[1]);
    for (int i = 1; i <= kSteps; ++i) {
      const Eigen::Vector2d at = turn.from + (turn.to - turn.from) * i / kSteps;
      const Eigen::Isometry3d X = StandingFoot(foot, {1, 2}, 0.5, at[0], at[1]);
      most = std::max(most, WayOf(foot, before, X));
      before = X;
    }
    // 1 rad/s would be 5 mm/s.
    EXPECT_LT(most * kSteps / (turn.to - turn.from).norm(), 0.005) << turn.from.transpose();
  }
}

TEST(BodyMapTest, AFrontThatIsNoDirectionIsRefused) {
  const std::string file = TestFolder() + "/map.xml";
  for (const char* forward : {"nan 0 0", "inf 0 0", "1e308 1e308 0", "0 0 1", "1 0 nan", "1 0"}) {
    WriteFileAtomically(file, std::string("<BodyMap forward=\"") + forward + "\"/>");
    EXPECT_THROW(ReadBodyMapChoice(file), Error) << forward;
  }
  WriteFileAtomically(file, "<BodyMap forward=\"2 2 0\"/>");
  EXPECT_NEAR(ReadBodyMapChoice(file).forward->x(), std::sqrt(0.5), 1e-12);
}

}  // namespace
}  // namespace mmm_converter
