// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "common/io/mmm/subject_file.h"
#include "common/support/error.h"
#include "tests/support/stick_model.h"
#include "tests/xml_config/xmllint.h"

namespace mmm_converter {
namespace {

constexpr const char* kSubjectSchema = "subject.xsd";

bool IsReadableSubject(const std::string& xml) {
  try {
    ParseSubject(xml, "subject.xml", testing::StickModel());
    return true;
  } catch (const Error&) {
    return false;
  }
}

TEST(SubjectSchema, TakesWhatIsWritten) {
  Subject subject;
  subject.name = "somebody";
  subject.model = "stick";
  subject.height = 1.7;
  subject.mass = 70;
  subject.hand_length = 0.18;
  EXPECT_TRUE(testing::IsValidText(kSubjectSchema, FormatSubject(subject, "program")));
  subject.scales = {{"knee", 1.05, 0.01, 0.06}};
  MarkerOffset offset;
  offset.marker = "MARKER_A";
  offset.prior_deviation = 0.04;
  offset.frames = 3;
  subject.offsets = {offset};
  subject.sources = {{"walk.c3d", 3}};
  EXPECT_TRUE(testing::IsValidText(kSubjectSchema, FormatSubject(subject, "program")));
}

TEST(SubjectSchema, AgreesWithTheReader) {
  const auto subject = [](const std::string& inside) {
    return "<Subject model='stick' height_m='1.7' mass_kg='70'>" + inside + "</Subject>";
  };
  const std::string marker = "<Markers><Marker name='MARKER_A' x_mm='1' y_mm='1' z_mm='";
  const std::string segment = "<Segments><Segment name='knee' scale='";
  for (const std::string& xml :
       {subject(""), subject("<Markers/><Segments/>"), subject(marker + "500'/></Markers>"),
        subject(segment + "0.5' observability='?'/></Segments>"),
        subject("<Joints><Joint name='knee' deviation_deg='4' with='MARKER_A hip'/></Joints>"),
        subject("<Provenance><Recording frames='0'/></Provenance>")}) {
    EXPECT_TRUE(testing::IsValidText(kSubjectSchema, xml)) << xml;
    EXPECT_TRUE(IsReadableSubject(xml)) << xml;
  }
  for (const std::string& xml :
       {std::string("<Subject model='stick' mass_kg='70'/>"),
        std::string("<Subject model='stick' height_m='2.6' mass_kg='70'/>"),
        std::string("<Subject model='stick' height_m='1.7' mass_kg='0'/>"),
        std::string("<Subject model='stick' height_m='1.7' mass_kg='70' hand_length_mm='18'/>"),
        subject("<Bones/>"), subject("<Joints><Joint name='knee' deviation_deg='181'/></Joints>"),
        subject("<Markers/><Markers/>"), subject(marker + "501'/></Markers>"),
        subject(marker + "nan'/></Markers>"), subject(marker + "1' frames='1.5'/></Markers>"),
        subject(marker + "1' xDeviation_mm='-1'/></Markers>"),
        subject(segment + "2.1'/></Segments>"), subject(segment + "1' mass='1'/></Segments>"),
        subject(segment + "1' standardDeviation='1.5'/></Segments>"),
        subject(segment + "1'/><Segment name='knee' scale='1'/></Segments>"),
        subject("<Segments><Segment scale='1'/></Segments>"),
        subject("<Provenance><Recording frames='-1'/></Provenance>")}) {
    EXPECT_FALSE(testing::IsValidText(kSubjectSchema, xml)) << xml;
    EXPECT_FALSE(IsReadableSubject(xml)) << xml;
  }
}

}  // namespace
}  // namespace mmm_converter
