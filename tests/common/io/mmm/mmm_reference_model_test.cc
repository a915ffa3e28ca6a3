// SPDX-License-Identifier: MIT
// Real MMM model files, the project's own reference model, and values that KIT's software computed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "common/io/mmm/mmm_model.h"
#include "common/io/xml/xml_document.h"
#include "common/math/rotation.h"
#include "common/model/forward_kinematics.h"
#include "common/model/model_scaling.h"
#include "common/support/text.h"
#include "tests/support/random_posture.h"
#include "tests/support/shared_data.h"
#include "tests/support/whole_body_inertia.h"

namespace mmm_converter {
namespace {

using ::testing::ElementsAreArray;
using ::testing::IsEmpty;
using testing::SharedData;
using testing::SourcePath;

constexpr const char* kModel2014 = "mmm/models/mmm_2014_82nodes_52markers.xml";
constexpr const char* kModel22 = "mmm/models/mmm_v2.2_133nodes_53markers.xml";

KinematicModel ReadWithoutWarnings(const std::string& path) {
  Warnings warnings;
  KinematicModel read = ReadMmmModel(path, &warnings);
  EXPECT_THAT(warnings.texts(), IsEmpty());
  return read;
}

int Count(const KinematicModel& model, JointType type) {
  return static_cast<int>(std::count_if(model.segments().begin(), model.segments().end(),
                                        [type](const Segment& s) { return s.type == type; }));
}

void ExpectLimits(const KinematicModel& model, const char* joint, const Eigen::Vector3d& axis,
                  double lower, double upper) {
  ASSERT_GE(model.FindJoint(joint), 0) << joint;
  const Segment& segment = model.joint(model.FindJoint(joint));
  EXPECT_EQ(segment.axis, axis) << joint;
  EXPECT_EQ(segment.lower, lower) << joint;
  EXPECT_EQ(segment.upper, upper) << joint;
}

const Eigen::Vector3d kX = Eigen::Vector3d::UnitX();
const Eigen::Vector3d kY = Eigen::Vector3d::UnitY();
const Eigen::Vector3d kZ = Eigen::Vector3d::UnitZ();

void ExpectLimitsOfAllModels(const KinematicModel& model) {
  ExpectLimits(model, "BLNx_joint", kX, -0.785398, 0.261799);
  ExpectLimits(model, "BPz_joint", kZ, -0.785398, 0.785398);
  ExpectLimits(model, "LHx_joint", kX, -0.872665, 1.65806);
  ExpectLimits(model, "LKx_joint", kX, -2.26893, 0);
  ExpectLimits(model, "LSy_joint", kY, 0, 2.79253);
  ExpectLimits(model, "RSy_joint", kY, -2.79253, 0);
  ExpectLimits(model, "LSCy_joint", kY, -0.349066, 0.349066);
  for (const char* still : {"root_joint", "LSCx_joint", "RSCx_joint"}) {
    ASSERT_GE(model.FindSegment(still), 0);
    EXPECT_EQ(model.FindJoint(still), -1) << still;
  }
}

TEST(RealModels, The2014Model) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const KinematicModel model = ReadWithoutWarnings(SharedData(kModel2014));
  EXPECT_EQ(model.segments().size(), 82u);
  EXPECT_EQ(model.segments()[0].name, "root_joint");
  EXPECT_EQ(Count(model, JointType::kRevolute), 49);
  EXPECT_EQ(Count(model, JointType::kPrismatic), 33);
  EXPECT_EQ(model.num_joints(), 46);  // 49 without root_joint, LSCx, RSCx
  EXPECT_EQ(model.markers().size(), 52u);
  EXPECT_EQ(model.FindMarker("MARKER_RFRA"), -1);
  EXPECT_NEAR(model.total_mass(), 1, 1e-12);
  EXPECT_EQ(std::count_if(model.segments().begin(), model.segments().end(),
                          [](const Segment& s) { return s.mass > 0; }),
            19);
  EXPECT_EQ(model.node_sets().at("All").size(), 82u);
  ExpectLimitsOfAllModels(model);
  ExpectLimits(model, "LFx_joint", kX, -0.523599, 0.785398);
  ExpectLimits(model, "RWy_joint", kY, -0.872665, 1.22173);
}

TEST(RealModels, TheModelOfMmm22) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const KinematicModel model = ReadWithoutWarnings(SharedData(kModel22));
  EXPECT_EQ(model.segments().size(), 129u);  // 133 without Virtual_Root, _X, _Y, _Z
  EXPECT_EQ(model.segments()[0].name, "root_joint");
  EXPECT_EQ(Count(model, JointType::kRevolute), 95);
  EXPECT_EQ(Count(model, JointType::kPrismatic), 28);
  EXPECT_EQ(Count(model, JointType::kFixed), 6);
  EXPECT_EQ(model.num_joints(), 92);
  EXPECT_EQ(model.markers().size(), 53u);
  EXPECT_NEAR(model.total_mass(), 1, 1e-12);
  EXPECT_EQ(model.node_sets().size(), 19u);
  EXPECT_EQ(model.node_sets().at("BodyVirtual").size(), 38u);
  ExpectLimitsOfAllModels(model);
  ExpectLimits(model, "LFx_joint", kX, -0.785398, 1.5708);
  ExpectLimits(model, "RWy_joint", kY, -1.5708, 1.22173);
  ExpectLimits(model, "LMrot_joint", kY, -0.261799, 0.261799);
  const ModelMarker& rhps = model.markers()[model.FindMarker("MARKER_RHPS")];
  EXPECT_EQ(model.segments()[rhps.segment].name, "RightFingerJoint50y_joint");
  // The format description gives three digits of a millimetre.
  EXPECT_NEAR((rhps.p_SM - Eigen::Vector3d(-8.155e-3, 8.358e-3, 29.273e-3)).norm(), 0, 1e-6);
}

TEST(RealModels, WintersLengthsOfAStandingPerson) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const KinematicModel model =
      ScaleWinter(ReadWithoutWarnings(SharedData(kModel2014)), {1.67, 100, std::nullopt});
  const std::vector<Eigen::Isometry3d> X_WS = SegmentPoses(model, ZeroPosture(model));
  const auto at = [&](const char* node) -> Eigen::Vector3d {
    return X_WS[model.FindSegment(node)].translation();
  };
  // Winter's table times 1.67 m; sums of decimal numbers, hence rounding only.
  const auto expect = [&](const char* node, double x, double z) {
    EXPECT_NEAR(at(node).x(), 1.67 * x, 1e-12) << node;
    EXPECT_NEAR(at(node).z(), 1.67 * z, 1e-12) << node;
  };
  expect("HeadSegment_joint", 0, 0.470);
  expect("LeftFootHeight_joint", -0.052, -0.530);
  expect("RightFootHeight_joint", 0.052, -0.530);
  expect("RKx_joint", 0.052, -0.245);
  expect("LSx_joint", -0.110, 0.288);
  expect("LWx_joint", -0.110, 0.288 - 0.188 - 0.145);
  expect("RightHandSegment_joint", 0.110, 0.288 - 0.188 - 0.145 - 0.108);
  expect("LeftHandSegment_joint", -0.110, 0.288 - 0.188 - 0.145 - 0.108);
}

std::vector<double> NumbersOf(const XmlElement& frame, const char* name) {
  std::vector<double> numbers;
  EXPECT_TRUE(AppendDoubles(frame.FindChild(name)->text, &numbers));
  return numbers;
}

Posture ReadPosture(const KinematicModel& model, const XmlElement& motion,
                    const XmlElement& frame) {
  const auto numbers = [&](const char* name) { return NumbersOf(frame, name); };
  Posture posture = ZeroPosture(model);
  posture.position = 1e-3 * Eigen::Vector3d(numbers("RootPosition").data());
  posture.orientation = RotationFromRpy(Eigen::Vector3d(numbers("RootRotation").data()));
  const std::vector<double> angles = numbers("JointPosition");
  const auto joints = motion.FindChild("JointOrder")->FindChildren("Joint");
  for (std::size_t i = 0; i < joints.size(); ++i) {
    posture.joint_angles[model.FindJoint(*joints[i]->FindAttribute("name"))] = angles.at(i);
  }
  return posture;
}

// KIT's old tools apply a segment's own centre of mass 1000 times too small; everything else of
// this value checks tree, axes, root rotation and scaling.
TEST(RealModels, StoredCentersOfMassAreReproduced) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const KinematicModel scaled =
      ScaleWinter(ReadWithoutWarnings(SharedData(kModel2014)), {1.67, 100, std::nullopt});
  ModelDescription old_tools{scaled.name(), scaled.segments(), {}, {}};
  for (Segment& segment : old_tools.segments) segment.p_SB *= 1e-3;
  const KinematicModel model(std::move(old_tools));

  const XmlElement file =
      ReadXmlFile(SharedData("mmm/motions_legacy/test_mmm_subject314_40joints_100Hz.xml"));
  const XmlElement& motion = *file.FindChild("Motion");
  ASSERT_EQ(motion.FindChild("JointOrder")->FindChildren("Joint").size(), 40u);
  const auto frames = motion.FindChild("MotionFrames")->FindChildren("MotionFrame");
  ASSERT_EQ(frames.size(), 265u);
  double worst = 0;
  for (const XmlElement* frame : frames) {
    const Eigen::Vector3d stored(NumbersOf(*frame, "CoM").data());
    const Posture posture = ReadPosture(model, motion, *frame);
    worst = std::max(worst, (1e3 * CenterOfMass(model, posture) - stored).norm());
  }
  EXPECT_LT(worst, 0.01) << "mm; the file has 6 digits, i.e. 0.005 mm";
}

class ReferenceModel : public ::testing::Test {
 protected:
  ReferenceModel() : ours_(ReadWithoutWarnings(SourcePath("xml_config/models/mmm.xml"))) {}

  const KinematicModel ours_;
};
using ReferenceModelRealFiles = ReferenceModel;

/// The same posture for a model whose joints have another order.
Posture Reordered(const Posture& posture, const KinematicModel& from, const KinematicModel& to) {
  Posture other = posture;
  for (int i = 0; i < from.num_joints(); ++i) {
    other.joint_angles[to.FindJoint(from.joint(i).name)] = posture.joint_angles[i];
  }
  return other;
}

TEST_F(ReferenceModelRealFiles, HasTheNamesAndFiguresOfMmm22) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const KinematicModel real = ReadWithoutWarnings(SharedData(kModel22));
  ASSERT_EQ(ours_.segments().size(), real.segments().size());
  ASSERT_EQ(ours_.num_joints(), real.num_joints());
  ASSERT_EQ(ours_.markers().size(), real.markers().size());
  for (const Segment& expected : real.segments()) {
    const int index = ours_.FindSegment(expected.name);
    ASSERT_GE(index, 0) << expected.name;
    const Segment& segment = ours_.segments()[index];
    EXPECT_EQ(segment.type, expected.type) << expected.name;
    EXPECT_EQ(segment.lower, expected.lower) << expected.name;
    // Hips of people who sit down bend further, and ankles of those who walk on bent knees.
    const bool is_ankle = expected.name == "LAx_joint" || expected.name == "RAx_joint";
    const bool is_hip = expected.name == "LHx_joint" || expected.name == "RHx_joint";
    EXPECT_EQ(segment.upper, is_ankle ? 0.872665
                             : is_hip ? 2.18166
                                      : expected.upper)
        << expected.name;
    EXPECT_EQ(segment.axis, expected.axis) << expected.name;
    EXPECT_EQ(segment.mass, expected.mass) << expected.name;
    EXPECT_EQ(segment.inertia, expected.inertia) << expected.name;
    EXPECT_LT((segment.p_SB - expected.p_SB).norm(), 1e-7) << expected.name;  // ours has 0.1 um
  }
}

TEST_F(ReferenceModelRealFiles, MovesAsTheOriginal) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const KinematicModel real = ReadWithoutWarnings(SharedData(kModel22));
  SeededRandom random(22);
  for (int trial = 0; trial < 50; ++trial) {
    const Posture q_real = testing::RandomPosture(real, random);
    const Posture q_ours = Reordered(q_real, real, ours_);
    const auto poses_real = SegmentPoses(real, q_real);
    const auto poses_ours = SegmentPoses(ours_, q_ours);
    // The demand is 1e-6 m; rounded text and rotations of the 1 m model make less.
    for (std::size_t i = 0; i < poses_real.size(); ++i) {
      const Eigen::Isometry3d& X = poses_ours[ours_.FindSegment(real.segments()[i].name)];
      ASSERT_LT((X.translation() - poses_real[i].translation()).norm(), 1e-6);
      ASSERT_LT((X.linear() - poses_real[i].linear()).norm(), 1e-5) << real.segments()[i].name;
    }
    const Eigen::Matrix3Xd markers_real = MarkerPositions(real, q_real);
    const Eigen::Matrix3Xd markers_ours = MarkerPositions(ours_, q_ours);
    for (std::size_t i = 0; i < real.markers().size(); ++i) {
      const int index = ours_.FindMarker(real.markers()[i].name);
      ASSERT_GE(index, 0) << real.markers()[i].name;
      const Eigen::Vector3d difference =
          markers_ours.col(index) - markers_real.col(static_cast<Eigen::Index>(i));
      ASSERT_LT(difference.norm(), 1e-6) << real.markers()[i].name;
    }
    ASSERT_LT((CenterOfMass(ours_, q_ours) - CenterOfMass(real, q_real)).norm(), 1e-6);
    const Eigen::Matrix3d inertia = testing::WholeBodyInertia(real, q_real);
    ASSERT_LT((testing::WholeBodyInertia(ours_, q_ours) - inertia).norm(), 1e-6 * inertia.norm());
  }
  EXPECT_NEAR(ours_.total_mass(), real.total_mass(), 1e-12);
}

TEST_F(ReferenceModel, HasTheNodeSetsForTracking) {
  const auto& sets = ours_.node_sets();
  EXPECT_EQ(sets.at("All").size(), ours_.segments().size());
  EXPECT_EQ(sets.at("Joints_Revolute").size(), 95u);
  EXPECT_EQ(sets.at("Joints_Prismatic").size(), 28u);
  EXPECT_EQ(sets.at("LeftHandJoints").size(), 22u);
  EXPECT_EQ(sets.at("RightHandJoints").size(), 22u);
  EXPECT_EQ(sets.at("MotionJoints40").size(), 40u);
  EXPECT_EQ(sets.at("MotionJoints44").size(), 44u);
  for (const char* set :
       {"MotionJoints40", "MotionJoints44", "LeftHandJoints", "RightHandJoints"}) {
    for (const std::string& name : sets.at(set)) EXPECT_GE(ours_.FindJoint(name), 0) << name;
  }
}

std::vector<std::string> JointOrderOf(const char* motion) {
  std::vector<std::string> names;
  const XmlElement file = ReadXmlFile(SharedData(motion));
  for (const XmlElement* joint :
       file.FindChild("Motion")->FindChild("JointOrder")->FindChildren("Joint")) {
    names.push_back(*joint->FindAttribute("name"));
  }
  return names;
}

TEST_F(ReferenceModelRealFiles, ListsTheJointsInTheOrderOfRealMotions) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  EXPECT_THAT(
      ours_.node_sets().at("MotionJoints40"),
      ElementsAreArray(JointOrderOf("mmm/motions_legacy/test_mmm_subject314_40joints_100Hz.xml")));
  EXPECT_THAT(ours_.node_sets().at("MotionJoints44"),
              ElementsAreArray(JointOrderOf("mmm/motions_legacy/walking_medium01_motion395.xml")));
}

}  // namespace
}  // namespace mmm_converter
