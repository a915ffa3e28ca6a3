// SPDX-License-Identifier: MIT
#include "common/judge/label_verdict.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/pipeline/recording_labels.h"

namespace mmm_converter {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr int kLength = 10;
constexpr double kNear = 0.005;  // [m]

// Points 0, 1, ... have the names of the same numbers in all frames, those beyond the names none.
struct Case {
  Recording recording;
  NamingFigures naming;
};

Case MakeCase(int points, int found, int names, double probability = 1) {
  Labelling labelling;
  std::vector<std::string> labels;
  for (int i = 0; i < points; ++i) {
    labels.push_back("*" + std::to_string(i));
    labelling.pieces.push_back(
        {LabelIx(i), 0, kLength, i < found ? i : -1, i < found ? probability : 0.9});
  }
  for (int i = 0; i < names; ++i) labelling.names.push_back("N" + std::to_string(i));
  return {{}, MeasureNaming(labelling, MarkerSequence(labels, kLength, 100, 0))};
}

Verdict Judge(const Case& judged, double distance = kNear, bool is_calibrated = true) {
  LabelFit fit;
  fit.mean_distance = distance;
  return JudgeLabels({judged.recording, judged.naming, fit, is_calibrated});
}

TEST(LabelVerdict, IsGoodWhereEveryNameIsSurelyFound) {
  const Verdict verdict = Judge(MakeCase(4, 4, 4));
  EXPECT_EQ(verdict.level, Verdict::Level::kGood);
  EXPECT_THAT(verdict.reasons, IsEmpty());
}

TEST(LabelVerdict, IsNotGoodWhereTheBodyContradictsNames) {
  const Case right = MakeCase(4, 4, 4);
  NamedMarkers names;
  for (int i = 0; i < 3; ++i) {
    NamedLabel& one = names.labels.emplace_back();
    one.label = "N" + std::to_string(i);
    one.readings = {{0, BodySide::kLeft}};
    one.note = "exchanged";
  }
  LabelFit fit;
  fit.mean_distance = kNear;
  LabelEvidence evidence = {right.recording, right.naming, fit, true};
  evidence.names = &names;
  EXPECT_EQ(JudgeLabels(evidence).level, Verdict::Level::kGood);
  names.labels[0].is_contradicted = true;
  EXPECT_EQ(JudgeLabels(evidence).level, Verdict::Level::kCheck);
  names.labels[1].is_contradicted = true;
  const Verdict verdict = JudgeLabels(evidence);
  EXPECT_EQ(verdict.level, Verdict::Level::kFailed);
  EXPECT_THAT(verdict.reasons, ElementsAre(HasSubstr("N0, N1 (exchanged)")));
}

TEST(LabelVerdict, CountsNamesThatAreNotFound) {
  // A marker that is not worn is no fault, a point that stays without a name beside it is.
  EXPECT_EQ(Judge(MakeCase(4, 4, 5)).level, Verdict::Level::kGood);
  const Case spare = MakeCase(5, 4, 5);
  EXPECT_THAT(spare.naming.missing, ElementsAre("N4"));
  EXPECT_EQ(Judge(spare).level, Verdict::Level::kCheck);
  EXPECT_THAT(Judge(spare).reasons, ElementsAre(HasSubstr("worn elsewhere")));
  EXPECT_EQ(Judge(MakeCase(4, 4, 8)).level, Verdict::Level::kCheck);
  EXPECT_EQ(Judge(MakeCase(3, 3, 8)).level, Verdict::Level::kFailed);
}

TEST(LabelVerdict, KnowsADistanceByWhoIsCalibrated) {
  const Case right = MakeCase(4, 4, 4);
  EXPECT_EQ(Judge(right, 0.04, false).level, Verdict::Level::kGood);
  EXPECT_EQ(Judge(right, 0.04, true).level, Verdict::Level::kCheck);
  EXPECT_EQ(Judge(right, 0.2, false).level, Verdict::Level::kFailed);
}

TEST(LabelVerdict, SeesWhatAMeanDistanceHides) {
  const Case right = MakeCase(4, 4, 4);
  const auto judge = [&](const LabelFit& fit) {
    return JudgeLabels({right.recording, right.naming, fit, false, 1.75});
  };
  LabelFit fit{0.04, 0.1, 0.15, {}, 1.78};
  EXPECT_EQ(judge(fit).level, Verdict::Level::kGood);
  fit.p95_distance = 0.5;
  EXPECT_EQ(judge(fit).level, Verdict::Level::kFailed);
  fit = {0.04, 0.1, 0.5, {"N1", "N3"}, 1.78};
  EXPECT_EQ(judge(fit).level, Verdict::Level::kCheck);
  EXPECT_THAT(judge(fit).reasons, ElementsAre(HasSubstr("N1, N3; are the points")));
  fit.farthest = 1.2;
  EXPECT_EQ(judge(fit).level, Verdict::Level::kFailed);
}

TEST(LabelVerdict, SaysByWhichScaleThePointsFit) {
  const Case right = MakeCase(4, 4, 4);
  const LabelFit fit{0.04, 0.1, 0.15, {}, 1.3 * 1.75};
  const Verdict verdict = JudgeLabels({right.recording, right.naming, fit, false, 1.75});
  EXPECT_EQ(verdict.level, Verdict::Level::kFailed);
  EXPECT_THAT(verdict.reasons, ElementsAre(HasSubstr("2.27 m, 1.30 times the height of 1.75 m")));
}

TEST(LabelVerdict, AddsUpHowSureNamesAre) {
  EXPECT_EQ(Judge(MakeCase(4, 4, 4, 0.95)).level, Verdict::Level::kGood);
  EXPECT_THAT(Judge(MakeCase(4, 4, 4, 0.8)).reasons, ElementsAre("names are sure to 80 % only"));
  EXPECT_EQ(Judge(MakeCase(4, 4, 4, 0.5)).level, Verdict::Level::kFailed);
}

TEST(LabelVerdict, HasTheGravestReasonFirst) {
  const Verdict verdict = Judge(MakeCase(4, 4, 4, 0.8), 1);
  EXPECT_EQ(verdict.level, Verdict::Level::kFailed);
  EXPECT_THAT(verdict.reasons, ElementsAre(HasSubstr("mm from the markers"), HasSubstr("sure to")));
}

}  // namespace
}  // namespace mmm_converter
