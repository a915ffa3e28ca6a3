// SPDX-License-Identifier: MIT
#include "common/io/mmm/subject_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "common/support/error.h"
#include "tests/support/stick_model.h"
#include "tests/support/test_folder.h"

namespace mmm_converter {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::SizeIs;
using testing::StickModel;
using ::testing::ThrowsMessage;

Subject FullSubject() {
  Subject subject;
  subject.name = "Anna & \"Bob\"";
  subject.model = "stick";
  subject.height = 1.68;
  subject.mass = 62.5;
  subject.hand_length = 0.1815;
  subject.scales = {{"knee", 1.031234, 0.0042, 0.06}, {"hip", 1, 0.06, 0.06}};
  MarkerOffset offset;
  offset.marker = "MARKER_C";
  offset.offset = {0.0123456, -0.02, 0};
  offset.standard_deviations = {0.001, 0.0021, 0.04};
  offset.prior_deviation = 0.04;
  offset.skin_deviation = 0.0015;
  offset.frames = 117;
  subject.offsets = {offset};
  subject.joints = {{"knee", 0.1, {"MARKER_C", "hip"}}, {"hip", 0.03, {}}};
  subject.sources = {{"Cut_1723.c3d", 60}, {"Peel_1723.c3d", 57}};
  return subject;
}

Subject Parse(const std::string& xml) { return ParseSubject(xml, "s.xml", StickModel()); }

std::string WithInside(const std::string& inside) {
  return "<Subject model='stick' height_m='1.7' mass_kg='60'>\n" + inside + "</Subject>";
}

TEST(SubjectFile, IsReadAsWritten) {
  const Subject written = FullSubject();
  const Subject read = Parse(FormatSubject(written, "program 1"));
  EXPECT_EQ(read.name, written.name);
  EXPECT_EQ(read.model, written.model);
  EXPECT_EQ(read.height, written.height);
  EXPECT_EQ(read.mass, written.mass);
  EXPECT_DOUBLE_EQ(read.hand_length.value(), 0.1815);
  ASSERT_THAT(read.scales, SizeIs(2));
  EXPECT_EQ(read.scales[0].segment, "knee");
  EXPECT_EQ(read.scales[0].scale, 1.031234);
  EXPECT_EQ(read.scales[0].standard_deviation, 0.0042);
  EXPECT_EQ(read.scales[0].prior_deviation, 0.06);
  ASSERT_THAT(read.offsets, SizeIs(1));
  const MarkerOffset& offset = read.offsets[0];
  EXPECT_EQ(offset.marker, "MARKER_C");
  // 0.1 micrometres are written.
  EXPECT_LE((offset.offset - written.offsets[0].offset).cwiseAbs().maxCoeff(), 0.51e-7);
  EXPECT_TRUE(offset.standard_deviations.isApprox(written.offsets[0].standard_deviations, 1e-12));
  EXPECT_DOUBLE_EQ(offset.prior_deviation, 0.04);
  EXPECT_DOUBLE_EQ(offset.skin_deviation, 0.0015);
  EXPECT_EQ(offset.frames, 117);
  ASSERT_THAT(read.joints, SizeIs(2));
  EXPECT_EQ(read.joints[0].joint, "knee");
  EXPECT_NEAR(read.joints[0].deviation, 0.1, 1e-4) << "hundredths of a degree are written";
  EXPECT_EQ(read.joints[0].partners, written.joints[0].partners);
  EXPECT_TRUE(read.joints[1].partners.empty());
  ASSERT_THAT(read.sources, SizeIs(2));
  EXPECT_EQ(read.sources[1].recording, "Peel_1723.c3d");
  EXPECT_EQ(read.sources[1].frames, 57);
}

TEST(SubjectFile, IsWrittenAsRead) {
  const std::string once = FormatSubject(FullSubject(), "p");
  const std::string twice = FormatSubject(Parse(once), "p");
  EXPECT_EQ(twice, once);
  EXPECT_EQ(FormatSubject(Parse(twice), "p"), once);
}

TEST(SubjectFile, SaysObservabilityAndProgramToPeople) {
  const std::string text = FormatSubject(FullSubject(), "MMMConverterS2KF 1.0.0");
  EXPECT_THAT(text, AllOf(HasSubstr("program=\"MMMConverterS2KF 1.0.0\""),
                          HasSubstr("observability=\"1\""), HasSubstr("observability=\"0\"")));
  // Nothing of it is taken back.
  std::string changed = text;
  changed.replace(changed.find("observability=\"1\""), 17, "observability=\"?\"");
  EXPECT_EQ(FormatSubject(Parse(changed), "MMMConverterS2KF 1.0.0"), text);
}

TEST(SubjectFile, HeightAndMassAreEnough) {
  const Subject subject =
      Parse(WithInside("<Markers><Marker name='MARKER_A' x_mm='1' y_mm='2' "
                       "z_mm='-3'/></Markers>"));
  EXPECT_EQ(subject.height, 1.7);
  EXPECT_FALSE(subject.hand_length);
  EXPECT_TRUE(subject.offsets.at(0).offset.isApprox(Eigen::Vector3d(1e-3, 2e-3, -3e-3)));
  EXPECT_EQ(subject.offsets[0].prior_deviation, 0);
  EXPECT_THAT(FormatSubject(subject, ""), Not(HasSubstr("observability=")));
}

TEST(SubjectFile, AllErrorsAreSaidWithTheirLines) {
  const std::string xml = WithInside(
      "<Segments>\n"
      "<Segment name='kneee' scale='1'/>\n"
      "<Segment name='knee' scale='nan'/>\n"
      "<Segment name='knee' scale='1.1'/>\n"
      "<Segment name='hip' scale='3'/>\n"
      "<Segment name='hip2' scale='1,1' size='2'/>\n"
      "<Segment scale='1'/>\n"
      "<Bone/>\n"
      "</Segments>\n"
      "<Markers>\n"
      "<Marker name='MARKER_E' x_mm='1' y_mm='1' z_mm='1'/>\n"
      "<Marker name='MARKER_A' x_mm='600' y_mm='inf'/>\n"
      "<Marker name='MARKER_B' x_mm='1' y_mm='1' z_mm='1' xDeviation_mm='-1' frames='2.5'/>\n"
      "</Markers>\n<Segments/>\n<Shoes/>\n");
  EXPECT_THAT(
      [&] { Parse(xml); },
      ThrowsMessage<Error>(AllOf(
          HasSubstr("s.xml:3: <Segment>: the model stick has no \"kneee\" (did you mean knee?)"),
          HasSubstr("s.xml:4: <Segment>: scale=\"nan\" is not allowed; use a number from 0.5 to 2"),
          HasSubstr("s.xml:5: <Segment>: knee is already in line 4; keep one of them"),
          HasSubstr("s.xml:6: <Segment>: scale=\"3\" is not allowed"),
          HasSubstr("s.xml:7: <Segment>: unknown attribute size; use name, scale"),
          HasSubstr("s.xml:7: <Segment>: scale=\"1,1\" is not allowed"),
          HasSubstr("s.xml:8: <Segment>: needs name=\"...\""),
          HasSubstr("s.xml:9: <Bone>: <Segments> has only <Segment>"),
          HasSubstr("s.xml:12: <Marker>: the model stick has no \"MARKER_E\""),
          HasSubstr(
              "s.xml:13: <Marker>: x_mm=\"600\" is not allowed; use a number from -500 to 500"),
          HasSubstr("s.xml:13: <Marker>: y_mm=\"inf\""),
          HasSubstr("s.xml:13: <Marker>: needs z_mm=\"...\""),
          HasSubstr("s.xml:14: <Marker>: xDeviation_mm=\"-1\" is not allowed"),
          HasSubstr("s.xml:14: <Marker>: frames=\"2.5\" is not allowed; use a whole number from 0"),
          HasSubstr("s.xml:16: <Segments>: Segments is already in line 2"),
          HasSubstr("s.xml:17: <Shoes>: use Segments, Markers, Joints or Provenance"))));
}

TEST(SubjectFile, RefusesImpossiblePersonsAndOtherModels) {
  EXPECT_THAT([] { Parse("<Subject model='stick' height_m='168' mass_kg='0'/>"); },
              ThrowsMessage<Error>(
                  AllOf(HasSubstr("height_m=\"168\" is not allowed; use a number from 0.5 to 2.5"),
                        HasSubstr("mass_kg=\"0\" is not allowed"))));
  EXPECT_THAT([] { Parse("<Subject model='stick'/>"); },
              ThrowsMessage<Error>(AllOf(HasSubstr("s.xml:1: <Subject>: needs height_m=\"...\""),
                                         HasSubstr("needs mass_kg=\"...\""))));
  EXPECT_THAT([] { Parse("<Subject model='MMM' height_m='1.7' mass_kg='60'/>"); },
              ThrowsMessage<Error>(HasSubstr("a subject of the model \"MMM\", this model is "
                                             "\"stick\"")));
}

TEST(SubjectFile, RefusesOtherFiles) {
  EXPECT_THAT([] { Parse("<ModelProcessorConfig type='Winter'/>"); },
              ThrowsMessage<Error>(HasSubstr("s.xml:1: this is a <ModelProcessorConfig> file")));
  EXPECT_THAT([] { Parse("<Subject"); }, ThrowsMessage<Error>(HasSubstr("s.xml")));
  EXPECT_THAT([] { ReadSubject("/no/such.xml", StickModel()); },
              ThrowsMessage<Error>(HasSubstr("/no/such.xml")));
}

TEST(SubjectFile, IsReadFromAFile) {
  const std::string path = testing::TestFolder() + "/subject.xml";
  std::ofstream(path) << FormatSubject(FullSubject(), "p");
  EXPECT_EQ(FormatSubject(ReadSubject(path, StickModel()), "p"),
            FormatSubject(Parse(FormatSubject(FullSubject(), "p")), "p"));
}

}  // namespace
}  // namespace mmm_converter
