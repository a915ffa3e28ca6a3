// SPDX-License-Identifier: MIT
// Rules of verdicts on made figures: at a limit, just beyond it, and where a figure is not known.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "common/fit/rigid_shape.h"
#include "common/judge/body_rules.h"
#include "common/judge/calibration_verdict.h"
#include "common/judge/conversion_verdict.h"

namespace mmm_converter {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using Level = Verdict::Level;

constexpr int kRuleFrames = 10;  // the fewest that are a motion
constexpr double kRuleRate = 100;

double Beyond(double limit) { return std::nextafter(limit, kNever); }

/// The verdict of a person of 1.75 m, all of whose figures are right until a case spoils one.
class ConversionRulesTest : public ::testing::Test {
 protected:
  ConversionRulesTest() {
    recording_.markers = MarkerSequence({"A", "B"}, kRuleFrames, kRuleRate, 0);
    result_.residuals = Eigen::MatrixXd::Constant(2, kRuleFrames, 0.01);
    figures_.distance = {2L * kRuleFrames, 0.01, 0.01, 0.01, 0.01};
    figures_.of_markers = {figures_.distance, figures_.distance};
    evidence_.height = 1.75;
    evidence_.body.coverage = {20, {{"left leg", 4, 0, {LabelIx(0), LabelIx(1)}}}, {}};
  }

  std::vector<std::string> Reasons() const { return JudgeConversion(evidence_).reasons; }
  Level VerdictLevel() const { return JudgeConversion(evidence_).level; }

  /// Good at the limit and of what is not known, doubtful beyond.
  void ExpectLimit(double* figure, double limit, const std::string& reason) const {
    *figure = limit;
    EXPECT_THAT(Reasons(), IsEmpty()) << reason;
    *figure = kNaN;
    EXPECT_THAT(Reasons(), IsEmpty()) << reason;
    *figure = Beyond(limit);
    EXPECT_THAT(Reasons(), ElementsAre(HasSubstr(reason)));
    EXPECT_EQ(VerdictLevel(), Level::kCheck);
  }
  void ExpectFailure(double* figure, double limit) const {
    *figure = limit;
    EXPECT_EQ(VerdictLevel(), Level::kCheck);
    *figure = Beyond(limit);
    EXPECT_EQ(VerdictLevel(), Level::kFailed);
  }

  Recording recording_;
  std::vector<MarkerAssignment> assignments_ = {{LabelIx(0), MarkerIx(0), 1},
                                                {LabelIx(1), MarkerIx(1), 1}};
  ConversionResult result_;
  ConversionFigures figures_;
  Subject subject_;
  NamedMarkers names_;
  ConversionEvidence evidence_{recording_, 100, assignments_, result_, figures_};
};

TEST_F(ConversionRulesTest, DistancesOfAPersonOfAHeight) {
  ExpectLimit(&figures_.distance.mean, 0.055, "markers are 55 mm from the model");
  ExpectFailure(&figures_.distance.mean, 0.15);
}

TEST_F(ConversionRulesTest, DistancesOfACalibratedPerson) {
  evidence_.subject = &subject_;
  ExpectLimit(&figures_.distance.p95, 0.06, "5 % of the marker positions");
  ExpectFailure(&figures_.distance.p95, 0.2);
}

TEST_F(ConversionRulesTest, DistancesOfAMarker) {
  ExpectLimit(&figures_.of_markers[1].mean, 0.22, "1 of 2 markers are on average");
  ExpectFailure(&figures_.of_markers[1].mean, 0.6);
}

TEST_F(ConversionRulesTest, DistancesOfAnObjectBesideItsSize) {
  evidence_.object_model = "box.xml";
  evidence_.body.radius = 0.25;
  ExpectLimit(&figures_.distance.mean, 0.25 * kMostStray, "from the model box.xml");
  ExpectFailure(&figures_.distance.mean, 0.125);
}

TEST_F(ConversionRulesTest, APositionThatIsFar) {
  result_.residuals(1, 3) = 0.4;
  ExpectLimit(&figures_.distance.max, 0.3, "farthest is B in frame 103");
}

TEST_F(ConversionRulesTest, PositionsOfLabelsThatAreExchangedAreNotFar) {
  result_.residuals.col(3).setConstant(0.4);
  figures_.distance.max = 0.4;
  result_.incidents = {{MarkerIncident::Kind::kSwapped, 0, 1, 3, 3}};
  EXPECT_THAT(Reasons(), Not(Contains(HasSubstr("in frame 103"))));
  result_.incidents[0].last_frame = 2;
  result_.incidents[0].first_frame = 2;
  EXPECT_THAT(Reasons(), Contains(HasSubstr("farthest is A in frame 103, by 400 mm")));
}

TEST_F(ConversionRulesTest, Noise) {
  ExpectLimit(&evidence_.body.noise, 0.003, "noise of 3.0 mm");
  ExpectFailure(&evidence_.body.noise, 0.03);
}

TEST_F(ConversionRulesTest, ATrunkThatLies) {
  ExpectLimit(&evidence_.body.trunk.lying, 0.9, "the trunk lies");
  evidence_.body.trunk.lying = 0;
  ExpectLimit(&evidence_.body.trunk.upside_down, 0.9, "the body is upside down");
  recording_.up_axis_is_doubtful = true;
  EXPECT_THAT(Reasons(), IsEmpty());
}

TEST_F(ConversionRulesTest, AJumpIsMeasuredByTheRate) {
  evidence_.body.jumps = {kNaN, 0, 0, 0.05};
  ExpectLimit(&evidence_.body.jumps[2], 0.1,
              "jump 1 time by up to 100 mm within a frame, first in "
              "frame 102");
  recording_.markers = MarkerSequence({"A", "B"}, kRuleFrames, 10, 0);
  ExpectLimit(&evidence_.body.jumps[2], 0.25, "by up to 250 mm");
}

TEST_F(ConversionRulesTest, AHeightThatMarkersContradict) {
  evidence_.height_source = "given";
  evidence_.height = 1;
  evidence_.told_height = HeightEstimate{1, 0.03, 12, 0};
  EXPECT_THAT(Reasons(), IsEmpty());
  evidence_.told_height->height = 0.91;
  EXPECT_THAT(Reasons(), ElementsAre(HasSubstr("the height is 1.00 m (given)")));
  evidence_.told_height->mean_distance = Beyond(0.055);  // no height explains them
  EXPECT_THAT(Reasons(), IsEmpty());
}

TEST_F(ConversionRulesTest, SidesThatAreExchanged) {
  evidence_.labels.sides = ExchangedSides{"the legs", 0.08, 0.03, {}};
  EXPECT_THAT(Reasons(), ElementsAre(HasSubstr("labels of the legs are exchanged")));
  EXPECT_EQ(VerdictLevel(), Level::kFailed);
}

TEST_F(ConversionRulesTest, AMarkerOfThePelvisThatSlips) {
  evidence_.body.slipped = SlippedMarkers{{"LASI", "RASI", "LPSI", "RPSI"}, 2.5, 0};
  ExpectLimit(&evidence_.body.slipped->distance, 0.013,
              "one of LASI, RASI, LPSI, RPSI seems to slip by 13 mm or more at about 2.5 s");
}

TEST_F(ConversionRulesTest, ALandmarkThatACalibrationMoves) {
  evidence_.subject = &subject_;
  MarkerOffset moved;
  moved.marker = "MARKER_LASI";
  moved.prior_deviation = 0.0085;
  subject_.offsets = {moved};
  ExpectLimit(&subject_.offsets[0].offset.x(), 0.055, "MARKER_LASI (55 mm)");
  subject_.offsets[0].prior_deviation = 0.03;  // a wand, say
  EXPECT_THAT(Reasons(), IsEmpty());
}

TEST_F(ConversionRulesTest, AHeelThatIsUpIsNoSoleThatSlopes) {
  evidence_.body.limits.soles = {{"left", 0.3}};
  EXPECT_THAT(Reasons(), ElementsAre(HasSubstr("the left foot's sole slopes by 17 degrees")));
  evidence_.body.limits.soles[0].slope = -0.3;
  EXPECT_THAT(Reasons(), ElementsAre(HasSubstr("the left foot's heel is up by 17 degrees")));
}

TEST_F(ConversionRulesTest, AGapBeforeTheBodyIsSeenIsALateStart) {
  evidence_.body.gaps = {{"the left leg", 0, 3, 1}};
  EXPECT_THAT(Reasons(), ElementsAre(HasSubstr("the left leg is hidden for 1.0 s, frames 100")));
  recording_.markers = MarkerSequence({"A", "B"}, kRuleFrames, 10, 0);
  result_.residuals.leftCols(5).setConstant(kNaN);
  EXPECT_THAT(Reasons(), IsEmpty());  // of 0.5 s, which a prediction bridges
  result_.residuals.leftCols(6).setConstant(kNaN);
  EXPECT_THAT(Reasons(), ElementsAre(HasSubstr("for 0.6 s, frames 100 to 105")));
}

TEST_F(ConversionRulesTest, WhatIsAskedForDependsOnWhatIsFar) {
  EXPECT_TRUE(AskAboutConversion(evidence_).places);
  EXPECT_FALSE(AskAboutConversion(evidence_).sides);
  EXPECT_FALSE(AskAboutConversion(evidence_).height);
  figures_.of_markers[0].mean = Beyond(0.22);
  EXPECT_FALSE(AskAboutConversion(evidence_).places);
  figures_.distance.mean = Beyond(0.055);
  EXPECT_TRUE(AskAboutConversion(evidence_).sides);
  EXPECT_TRUE(AskAboutConversion(evidence_).is_far);
  figures_.distance.mean = 0.01;
  evidence_.names = &names_;
  EXPECT_TRUE(AskAboutConversion(evidence_).sides);
  EXPECT_FALSE(AskAboutConversion(evidence_).is_far);
  evidence_.object_model = "box.xml";
  EXPECT_FALSE(AskAboutConversion(evidence_).sides);
}

TEST_F(ConversionRulesTest, OffsetsOfACalibratedPersonThatAreFar) {
  evidence_.subject = &subject_;
  subject_.offsets.resize(1);
  subject_.offsets[0].offset = {0.18, 0, 0};
  EXPECT_THAT(Reasons(), IsEmpty());
  EXPECT_FALSE(AskAboutConversion(evidence_).is_far);
  subject_.offsets[0].offset.x() = Beyond(0.18);
  EXPECT_THAT(Reasons(), ElementsAre(HasSubstr("5 % of the markers sit more than 180 mm")));
  EXPECT_TRUE(AskAboutConversion(evidence_).is_far);
}

std::vector<std::string> JudgeBody(const BodyLimits& limits) {
  VerdictReasons reasons;
  JudgeBodyLimits(limits, true, &reasons);
  return reasons.Conclude().reasons;
}

TEST(BodyRulesTest, JointsAtTheirLimits) {
  const double back = 5 / kDegrees;
  EXPECT_THAT(JudgeBody({{{"LAx_joint", 0.05, 0, kNaN}}, {}, {}}), IsEmpty());
  EXPECT_THAT(JudgeBody({{{"LAx_joint", Beyond(0.05), 0, kNaN}}, {}, {}}),
              ElementsAre(HasSubstr("LAx_joint (5 %)")));
  EXPECT_THAT(JudgeBody({{{"LKx_joint", 0, 1, kNaN}}, {}, {}}), IsEmpty());
  EXPECT_THAT(JudgeBody({{{"LKx_joint", 0, 1, back}}, {}, {}}), IsEmpty());
  EXPECT_THAT(JudgeBody({{{"LKx_joint", 0, 0.05, Beyond(back)}}, {}, {}}), IsEmpty());
  EXPECT_THAT(JudgeBody({{{"LKx_joint", 0, 1, Beyond(back)}}, {}, {}}),
              ElementsAre(HasSubstr("LKx_joint (100 %, bent backwards by 5 degrees)")));
}

TEST(BodyRulesTest, LegsAndSoles) {
  EXPECT_THAT(JudgeBody({{}, {{"left", 0.2}, {"right", kNaN}}, {{"left", kNaN}}}), IsEmpty());
  EXPECT_THAT(JudgeBody({{}, {{"left", Beyond(0.2)}}, {}}),
              ElementsAre(HasSubstr("the left ankle is above its hip in 20 %")));
  EXPECT_THAT(JudgeBody({{}, {}, {{"right", 14.9 / kDegrees}}}), IsEmpty());
  EXPECT_THAT(JudgeBody({{}, {}, {{"right", 15.1 / kDegrees}}}),
              ElementsAre(HasSubstr("the right foot's sole slopes by 15 degrees")));
}

TEST(BodyRulesTest, LimbsThatAreElsewhere) {
  const auto judge = [](const LimbPlace& place) {
    VerdictReasons reasons;
    JudgeLimbPlaces({place}, &reasons);
    return reasons.Conclude().reasons;
  };
  EXPECT_THAT(judge({"left leg", true, {"A"}, 0.5, 0.08}), IsEmpty());
  EXPECT_THAT(judge({"left leg", true, {"A"}, kNaN, kNaN}), IsEmpty());
  EXPECT_THAT(judge({"left leg", true, {"A"}, Beyond(0.5), Beyond(0.08)}),
              ElementsAre(HasSubstr("the left leg lies beside the trunk"),
                          HasSubstr("would bend backwards at the knee")));
  EXPECT_THAT(judge({"right arm", false, {"A"}, 0, 0.09}), ElementsAre(HasSubstr("at the elbow")));
}

TEST(LabelRulesTest, PlacesAreJudgedByWhatNamesLeaveOpen) {
  const auto judge = [](double noise_scale, double distance) {
    VerdictReasons reasons;
    JudgePlaces({{"A", noise_scale, distance}}, &reasons);
    return reasons.Conclude().reasons;
  };
  EXPECT_THAT(judge(1, 0.112), IsEmpty());
  EXPECT_THAT(judge(1, kNaN), IsEmpty());
  EXPECT_THAT(judge(1, Beyond(0.112)), ElementsAre(HasSubstr("A (112 mm)")));
  // A place that is known better than its posture.
  EXPECT_THAT(judge(0.375, 0.22), IsEmpty());
  EXPECT_THAT(judge(0.375, 0.24), ElementsAre(HasSubstr("A (90 mm)")));
}

TEST(LabelRulesTest, CoverageOfLimbs) {
  const auto judge = [](const Coverage& coverage) {
    VerdictReasons reasons;
    JudgeCoverage(coverage, &reasons);
    return reasons.Conclude();
  };
  const Limb known{"left leg", 3, 0, {LabelIx(0)}}, lost{"right leg", 4, 2, {LabelIx(1)}};
  EXPECT_THAT(judge({3, {known}, {}}).reasons, IsEmpty());  // 9 degrees of freedom
  EXPECT_EQ(judge({2, {known}, {}}).level, Level::kFailed);
  EXPECT_THAT(judge({3, {known, lost}, {}}).reasons,
              ElementsAre(HasSubstr("too few markers to know the right leg (1 marker)")));
  EXPECT_THAT(judge({3, {known}, {{"pelvis", 2, {}}}}).reasons,
              ElementsAre(HasSubstr("no marker is on the pelvis")));
}

}  // namespace
}  // namespace mmm_converter
