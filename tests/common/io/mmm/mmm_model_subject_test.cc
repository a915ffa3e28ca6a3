// SPDX-License-Identifier: MIT
#include "common/io/mmm/mmm_model_subject.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/io/bytes/file_content.h"
#include "common/io/mmm/mmm_model.h"
#include "common/math/seeded_random.h"
#include "common/model/model_scaling.h"
#include "common/support/error.h"
#include "tests/support/shared_data.h"

namespace mmm_converter {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

// 10 digits of at most 1 m; sums along no chain.
constexpr double kTextPrecision = 1e-9;

/// Every segment and marker, each with numbers of its own.
Subject RandomSubject(const KinematicModel& model, std::optional<double> hand_length) {
  SeededRandom random(7);
  Subject subject;
  subject.name = "somebody";
  subject.model = model.name();
  subject.height = 1.68;
  subject.mass = 62;
  subject.hand_length = hand_length;
  for (const Segment& segment : model.segments()) {
    subject.scales.push_back({segment.name, 0.9 + 0.2 * random.Uniform(), 0, 0});
  }
  for (const ModelMarker& marker : model.markers()) {
    MarkerOffset offset;
    offset.marker = marker.name;
    for (double& coordinate : offset.offset) coordinate = 0.03 * random.Normal();
    subject.offsets.push_back(offset);
  }
  return subject;
}

void ExpectSame(const KinematicModel& a, const KinematicModel& b) {
  ASSERT_EQ(a.segments().size(), b.segments().size());
  for (std::size_t i = 0; i < a.segments().size(); ++i) {
    const Segment& s = a.segments()[i];
    const Segment& t = b.segments()[i];
    SCOPED_TRACE(s.name);
    EXPECT_EQ(s.name, t.name);
    EXPECT_TRUE(s.X_PF.matrix().isApprox(t.X_PF.matrix(), kTextPrecision));
    EXPECT_LT((s.p_SB - t.p_SB).norm(), kTextPrecision);
    EXPECT_LE((s.inertia - t.inertia).norm(), kTextPrecision * s.inertia.norm());
    EXPECT_NEAR(s.lower, t.lower, kTextPrecision);
    EXPECT_NEAR(s.upper, t.upper, kTextPrecision);
    EXPECT_EQ(s.mass, t.mass);
    EXPECT_EQ(s.joint, t.joint);
  }
  ASSERT_EQ(a.markers().size(), b.markers().size());
  for (std::size_t i = 0; i < a.markers().size(); ++i) {
    EXPECT_LT((a.markers()[i].p_SM - b.markers()[i].p_SM).norm(), kTextPrecision)
        << a.markers()[i].name;
  }
  EXPECT_EQ(a.node_sets(), b.node_sets());
}

void ExpectAnyToolHasThePersonsModel(const std::string& file, std::optional<double> hand_length) {
  const std::string content = ReadFileContent(file);
  Warnings warnings;
  const KinematicModel reference = ParseMmmModel(content, file, &warnings);
  const Subject subject = RandomSubject(reference, hand_length);
  const WinterScaling person{subject.height, subject.mass, subject.hand_length};
  Warnings again;
  const KinematicModel read =
      ParseMmmModel(FormatSubjectModel(content, file, subject), "written", &again);
  EXPECT_EQ(again.all().size(), warnings.all().size());
  ExpectSame(ScaleWinter(read, person), FitToSubject(ScaleWinter(reference, person), subject));
}

TEST(SubjectModel, WinterGivesThePersonsModelOfTheShippedOne) {
  const std::string file = testing::SourcePath("xml_config/models/mmm.xml");
  ExpectAnyToolHasThePersonsModel(file, std::nullopt);
  ExpectAnyToolHasThePersonsModel(file, 0.19);
}

TEST(SubjectModelRealFiles, WinterGivesThePersonsModelOfRealOnes) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  for (const char* file : {"mmm/models/mmm_2014_82nodes_52markers.xml",
                           "mmm/models/mmm_v2.2_133nodes_53markers.xml"}) {
    SCOPED_TRACE(file);
    ExpectAnyToolHasThePersonsModel(testing::SharedData(file), std::nullopt);
    ExpectAnyToolHasThePersonsModel(testing::SharedData(file), 0.17);
  }
}

constexpr const char* kSmall = R"(<?xml version="1.0"?>
<!-- kept -->
<Robot Type='small'  RootNode="a">
  <RobotNode name="a"><Child name="b"/>
    <Sensor type="position" name="M1"/>
    <Sensor name="M2" type="position"><Transform><rollpitchyaw roll="0" pitch="0" yaw="90" units="degree"/></Transform></Sensor>
    <Sensor type="position" name="M3"><Transform/></Sensor></RobotNode>
  <RobotNode name='b'>
    <Transform><Translation units='cm' z ='5' x='0' y="1e1"/></Transform>
    <Visualization><File x="5">b.wrl</File></Visualization>
    <Sensor type="force" name="F"><Transform><Translation x="1" y="1" z="1"/></Transform></Sensor>
  </RobotNode>
</Robot>
)";

Subject SmallSubject() {
  Subject subject;
  subject.name = "a--b";
  subject.model = "small";
  subject.height = 2;
  subject.mass = 70;
  return subject;
}

TEST(SubjectModel, KeepsEveryOtherByte) {
  const std::string text = FormatSubjectModel(kSmall, "small.xml", SmallSubject());
  const std::size_t comment = text.find("<!-- Lengths");
  ASSERT_NE(comment, std::string::npos);
  std::string without = text;
  without.erase(comment, text.find("<Robot") - comment);
  EXPECT_EQ(without, kSmall);
  EXPECT_THAT(text, HasSubstr("the subject a- -b,"));  // two dashes would end the comment
}

TEST(SubjectModel, ChangesNumbersWhereTheyStand) {
  Subject subject = SmallSubject();
  subject.scales = {{"b", 1.1, 0, 0}};
  const std::string text = FormatSubjectModel(kSmall, "small.xml", subject);
  EXPECT_THAT(text, AllOf(HasSubstr("<Translation units='cm' z ='5.5' x='0' y=\"11\"/>"),
                          HasSubstr("<File x=\"5\">"), HasSubstr("<Translation x=\"1\" y=\"1\"")));
}

TEST(SubjectModel, MarkersWithoutAPlaceGetOne) {
  Subject subject = SmallSubject();
  for (const char* name : {"M1", "M2", "M3"}) {
    MarkerOffset offset;
    offset.marker = name;
    offset.offset = {0.02, 0, -0.04};
    subject.offsets.push_back(offset);
  }
  const std::string text = FormatSubjectModel(kSmall, "small.xml", subject);
  const KinematicModel model = ParseMmmModel(text, "written");
  ASSERT_EQ(model.markers().size(), 3u);
  for (const ModelMarker& marker : model.markers()) {  // of a person of 1 m, the subject has 2 m
    EXPECT_LT((marker.p_SM - Eigen::Vector3d(0.01, 0, -0.02)).norm(), kTextPrecision);
  }
}

TEST(SubjectModel, RefusesAnotherModel) {
  Subject subject = SmallSubject();
  subject.scales = {{"c", 1.1, 0, 0}};
  EXPECT_THAT([&] { FormatSubjectModel(kSmall, "small.xml", subject); },
              ThrowsMessage<Error>(HasSubstr("the subject names c")));
  EXPECT_THAT([&] { FormatSubjectModel("<MMM/>", "motion.xml", subject); },
              ThrowsMessage<Error>(HasSubstr("motion.xml:1: not a model")));
}

}  // namespace
}  // namespace mmm_converter
