// SPDX-License-Identifier: MIT
#include "common/judge/conversion_verdict.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "common/io/mmm/mmm_model.h"
#include "common/model/forward_kinematics.h"
#include "common/motion/marker_synthesis.h"
#include "common/study/told_distances.h"
#include "common/study/worn_distances.h"
#include "tests/support/shared_data.h"
#include "tests/support/synthetic_person.h"

namespace mmm_converter {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using Level = Verdict::Level;

constexpr double kSeconds = 4;

/// A person who is tracked as they move; cases spoil the evidence.
class ConversionVerdictTest : public ::testing::Test {
 protected:
  ConversionVerdictTest()
      : reference_(std::make_shared<const KinematicModel>(
            ReadMmmModel(testing::SourcePath("xml_config/models/mmm.xml")))),
        model_(std::make_shared<const KinematicModel>(testing::ScaledReferenceModel(1.75))) {
    person_.size = WinterScaling{1.75, 70, {}};
    const PoseTrajectory motion = testing::RangeOfMotion(*model_, kSeconds, 0.5, 1);
    recording_.markers = testing::RecordPerson(*model_, motion, 2);
    const std::vector<MarkerAssignment> all = testing::AssignAll(*model_, recording_.markers);
    std::vector<int> joints;
    for (const std::string& name : motion.joint_names) joints.push_back(model_->FindJoint(name));
    setup_ = testing::SetupOf(*model_, joints, all);
    result_.trajectory = motion;
    const auto frames = static_cast<Eigen::Index>(motion.postures.size());
    result_.residuals =
        Eigen::MatrixXd::Constant(static_cast<Eigen::Index>(all.size()), frames, 0.01);
    result_.frames.resize(motion.postures.size());
  }

  Verdict Judge() const {
    const ConversionFigures figures = MeasureConversion(result_);
    ConversionEvidence evidence{recording_, 0, setup_.assignments(), result_, figures};
    evidence.subject = person_.subject.get();
    evidence.height = person_.size->height;
    evidence.height_source = height_source_;
    evidence.body = MeasureBody(setup_, recording_.markers, result_);
    const Questions asked = AskAboutConversion(evidence);
    if (asked.places) {
      evidence.labels.places = MeasurePlaces(setup_, recording_.markers, result_.trajectory);
    }
    if (asked.height) {
      evidence.told_height = TellHeight(setup_, *reference_, recording_.markers, nullptr);
    }
    if (asked.sides) {
      evidence.labels.sides = FindExchangedSides(setup_, reference_, person_, recording_.markers);
    }
    return JudgeConversion(evidence);
  }

  int Label(const std::string& name) const { return recording_.markers.FindLabel(name); }
  int frames() const { return recording_.markers.num_frames(); }

  std::shared_ptr<const KinematicModel> reference_, model_;
  PersonScaling person_;
  Recording recording_;
  TrackingSetup setup_;
  ConversionResult result_;
  std::string height_source_;
};

TEST_F(ConversionVerdictTest, ARightTrackIsGood) {
  const Verdict verdict = Judge();
  EXPECT_EQ(verdict.level, Level::kGood);
  EXPECT_THAT(verdict.reasons, IsEmpty());
}

TEST_F(ConversionVerdictTest, DistancesOfAPersonOfThatHeightAreLargerThanOfACalibratedOne) {
  result_.residuals.setConstant(0.03);
  EXPECT_EQ(Judge().level, Level::kGood);
  result_.residuals.setConstant(0.06);
  EXPECT_THAT(Judge().reasons, ElementsAre(HasSubstr("markers are 60 mm from the model")));
  result_.residuals.setConstant(0.16);
  EXPECT_EQ(Judge().level, Level::kFailed);
  person_.subject = std::make_shared<Subject>();
  result_.residuals.setConstant(0.03);
  EXPECT_THAT(Judge().reasons, ElementsAre(HasSubstr("a calibrated person at most 20")));
}

TEST_F(ConversionVerdictTest, AMarkerThatIsFarIsNamed) {
  result_.residuals.row(3).setConstant(0.23);
  EXPECT_THAT(Judge().reasons, Contains(AllOf(HasSubstr("1 of 53 markers"),
                                              HasSubstr(recording_.markers.labels()[3]))));
}

TEST_F(ConversionVerdictTest, APositionThatIsFarIsNamedWithItsFrame) {
  result_.residuals(5, 17) = 0.4;
  EXPECT_THAT(Judge().reasons, ElementsAre(AllOf(HasSubstr("in frame 17, by 400 mm"),
                                                 HasSubstr(recording_.markers.labels()[5]))));
}

TEST_F(ConversionVerdictTest, ATrackThatIsLostOftenIsCheckedAndFailsWhereItIsMostlySo) {
  const auto lose = [&](double share) {
    for (int k = 0; k < static_cast<int>(share * frames()); ++k)
      result_.frames[k].reassembled = true;
  };
  lose(0.08);
  EXPECT_EQ(Judge().level, Level::kGood);
  lose(0.2);
  EXPECT_EQ(Judge().level, Level::kCheck);
  lose(0.6);
  EXPECT_EQ(Judge().level, Level::kFailed);
}

TEST_F(ConversionVerdictTest, LabelsThatLieOnOtherMarkersAreNamed) {
  MarkerIncident incident;
  incident.assignment = 2;
  incident.other = 4;
  incident.first_frame = 0;
  incident.last_frame = frames() - 1;
  result_.incidents = {incident};
  EXPECT_THAT(Judge().reasons, ElementsAre(AllOf(HasSubstr("4 % of the marker positions"),
                                                 HasSubstr(recording_.markers.labels()[2]))));
}

TEST_F(ConversionVerdictTest, AnArmThatIsHiddenForLongIsAReason) {
  const std::vector<std::string> arm = {"LUPA", "LAEL", "LAOL", "LFRA", "LWTS",
                                        "LWPS", "LIFD", "LHTS", "LHPS"};
  for (int k = 100; k < 300; ++k) {
    for (const std::string& name : arm) {
      ASSERT_GE(Label(name), 0) << name;
      recording_.markers.frame(k).col(Label(name)).setConstant(NAN);
    }
  }
  EXPECT_THAT(Judge().reasons, Contains(AllOf(HasSubstr("the left arm is hidden for 2.0 s"),
                                              HasSubstr("frames 100 to 299"))));
}

TEST_F(ConversionVerdictTest, ABodyThatIsElsewhereWithinAFrameIsAnotherOne) {
  for (int k = 150; k < frames(); ++k) recording_.markers.frame(k).row(0).array() += 0.5;
  EXPECT_THAT(Judge().reasons, Contains(AllOf(HasSubstr("jump 1 time"), HasSubstr("frame 150"))));
}

TEST_F(ConversionVerdictTest, ABodyUpsideDownIsToldWithTheAxis) {
  const Eigen::Quaterniond over(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()));
  for (Posture& posture : result_.trajectory.postures) {
    posture.orientation = over * posture.orientation;
  }
  EXPECT_THAT(Judge().reasons, Contains(HasSubstr("the body is upside down")));
}

TEST_F(ConversionVerdictTest, AHeightThatTheMarkersContradictIsTold) {
  height_source_ = "given";
  EXPECT_EQ(Judge().level, Level::kGood);
  person_.size->height = 1.95;
  EXPECT_THAT(Judge().reasons, Contains(HasSubstr("the height is 1.95 m (given), but the markers "
                                                  "are those of a person of 1.7")));
}

TEST_F(ConversionVerdictTest, AFewFramesAreNoMotion) {
  recording_.markers = recording_.markers.Slice(0, 9);
  result_.trajectory.postures.resize(9);
  result_.residuals = result_.residuals.leftCols(9).eval();
  result_.frames.resize(9);
  EXPECT_THAT(Judge().reasons, ElementsAre(HasSubstr("9 frames are too few")));
}

TEST_F(ConversionVerdictTest, JointsAtTheirLimitsAreToldOfAnyMarkerSet) {
  const auto& names = result_.trajectory.joint_names;
  const auto j = std::find(names.begin(), names.end(), "LAy_joint") - names.begin();
  const Segment& joint = model_->joint(setup_.joints[static_cast<std::size_t>(j)]);
  for (Posture& posture : result_.trajectory.postures) posture.joint_angles[j] = joint.upper;
  EXPECT_THAT(Judge().reasons,
              Contains(AllOf(HasSubstr("LAy_joint (100 %)"), HasSubstr("Calibrating the person"))));
}

/// How far a label is told to be from its place, if it is worn 80 mm beside that.
class LabelDistancesTest : public ConversionVerdictTest {
 protected:
  /// Moves a label along an axis of its segment, and fits the postures anew.
  void Move(const std::string& name, const Eigen::Vector3d& offset) {
    label_ = Label(name);
    const ModelMarker& marker =
        model_->markers()[static_cast<std::size_t>(model_->FindMarker("MARKER_" + name))];
    for (int k = 0; k < frames(); ++k) {
      const auto X_WS = SegmentPoses(*model_, ModelPosture(*model_, result_.trajectory, k));
      recording_.markers.frame(k).col(label_) +=
          X_WS[static_cast<std::size_t>(marker.segment)].linear() * offset;
    }
    result_.trajectory =
        testing::FitRecording(*model_, setup_.joints, setup_.assignments(), recording_.markers);
  }

  double ResidualOfLabel() const {
    double sum = 0;
    for (int k = 0; k < frames(); ++k) {
      const Eigen::Matrix3Xd p =
          MarkerPositions(*model_, ModelPosture(*model_, result_.trajectory, k));
      const int marker = setup_.assignments()[static_cast<std::size_t>(Assignment())].marker;
      sum += (p.col(marker) - recording_.markers.frame(k).col(label_)).norm();
    }
    return sum / frames();
  }

  int Assignment() const {
    for (std::size_t i = 0; i < setup_.assignments().size(); ++i) {
      if (setup_.assignments()[i].label == label_) return static_cast<int>(i);
    }
    return -1;
  }

  int label_ = -1;
};

TEST_F(LabelDistancesTest, ALabelInItsPlaceIsToldToBeThere) {
  EXPECT_LT(ToldDistances(setup_, recording_.markers, result_.trajectory).maxCoeff(), 0.02);
  EXPECT_LT(WornDistances(setup_, recording_.markers, result_.trajectory).maxCoeff(), 0.02);
}

TEST_F(LabelDistancesTest, WhatThePostureTakesUpOfAHeelIsTold) {
  Move("LHEE", {0, 0, 0.08});
  const double residual = ResidualOfLabel();
  const auto told = ToldDistances(setup_, recording_.markers, result_.trajectory);
  const auto worn = WornDistances(setup_, recording_.markers, result_.trajectory);
  EXPECT_LT(residual, 0.05);
  Eigen::Index farthest = 0;
  EXPECT_GT(told.maxCoeff(&farthest), 1.2 * residual);
  EXPECT_EQ(farthest, Assignment());
  EXPECT_GT(worn.maxCoeff(&farthest), 0.03);
  EXPECT_EQ(farthest, Assignment());
}

TEST_F(LabelDistancesTest, ALabelThatIsNeverSeenIsNotTold) {
  for (int k = 0; k < frames(); ++k) recording_.markers.frame(k).col(4).setConstant(NAN);
  label_ = 4;
  EXPECT_TRUE(
      std::isnan(ToldDistances(setup_, recording_.markers, result_.trajectory)[Assignment()]));
  EXPECT_TRUE(
      std::isnan(WornDistances(setup_, recording_.markers, result_.trajectory)[Assignment()]));
}

}  // namespace
}  // namespace mmm_converter
