// SPDX-License-Identifier: MIT
#include "common/convert/converter_config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/io/mmm/mmm_model.h"
#include "common/support/error.h"
#include "tests/support/shared_data.h"
#include "tests/support/stick_model.h"

namespace mmm_converter {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::ThrowsMessage;

ConverterConfig Parse(const std::string& inside, const std::string& type = "S2KFConverter",
                      Warnings* warnings = nullptr) {
  return ParseConverterConfig(
      "<ConverterConfig type='" + type + "'>\n" + inside + "\n</ConverterConfig>", "c.xml",
      warnings);
}

std::string ErrorOf(const std::string& inside) {
  try {
    Parse(inside);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(ConverterConfig, TakesTheShapeOfKit) {
  Warnings warnings;
  const ConverterConfig config = ParseConverterConfig(
      "<?xml version='1.0' encoding='UTF-8'?>\n"
      "<ConverterConfig type='NloptConverter'>\n"
      "  <Model name='Winter'>\n"
      "    <MarkerMapping>\n"
      "      <Mapping source=\"C7\" target=\"MARKER_C7\"/>\n"
      "      <Mapping source=\"L3\" target=\"MARKER_L3\" weight='1'/>\n"
      "    </MarkerMapping>\n"
      "    <Other/>\n"
      "  </Model>\n"
      "  <Strategy/>\n"
      "</ConverterConfig>",
      "c.xml", &warnings);
  EXPECT_EQ(config.type, "");
  EXPECT_EQ(config.model_processor, "Winter");
  ASSERT_EQ(config.marker_pairs.size(), 2u);
  EXPECT_EQ(config.marker_pairs[1].source, "L3");
  EXPECT_EQ(config.marker_pairs[1].target, "MARKER_L3");
  EXPECT_EQ(config.marker_pairs[1].noise_scale, 1);
  EXPECT_THAT(config.plugin_elements, IsEmpty());
  EXPECT_THAT(warnings.texts(), ElementsAre(HasSubstr("c.xml:6:"), HasSubstr("c.xml:8:"),
                                            HasSubstr("left out are Strategy")));
}

TEST(ConverterConfig, ReadsAllThatIsShared) {
  Warnings warnings;
  const ConverterConfig config = Parse(
      "<Model name='None'>\n"
      "<MarkerMapping><Mapping source=' C7 ' target='MARKER_C7' "
      "noiseScale='2.5'/></MarkerMapping>\n"
      "<Joints><Joint name='LKx_joint'/>\n<Joint name='RKx_joint'/></Joints></Model>\n"
      "<Filter type='ekf'/><Noise/>",
      "S2KFConverter", &warnings);
  EXPECT_EQ(config.file, "c.xml");
  EXPECT_EQ(config.type, "S2KFConverter");
  EXPECT_EQ(config.model_processor, "None");
  ASSERT_EQ(config.marker_pairs.size(), 1u);
  EXPECT_EQ(config.marker_pairs[0].source, "C7");
  EXPECT_EQ(config.marker_pairs[0].noise_scale, 2.5);
  ASSERT_EQ(config.joints.size(), 2u);
  EXPECT_EQ(config.joints[1].name, "RKx_joint");
  EXPECT_EQ(config.joints[1].line, 5);
  ASSERT_EQ(config.plugin_elements.size(), 2u);
  EXPECT_EQ(config.plugin_elements[0].name, "Filter");
  EXPECT_THAT(warnings.texts(), IsEmpty());
}

TEST(ConverterConfig, EverythingButTheTypeCanBeLeftOut) {
  const ConverterConfig config = Parse("");
  EXPECT_EQ(config.model_processor, "Winter");
  EXPECT_EQ(config.marker_set, "auto");
  EXPECT_EQ(config.joint_set, "auto");
  EXPECT_EQ(Parse("<Model><MarkerMapping set='kit53'/><Joints set='mmm40'/></Model>").marker_set,
            "kit53");
}

TEST(ConverterConfig, SubjectIsRelativeToTheFile) {
  const std::string xml =
      "<ConverterConfig type='S2KFConverter'><Model name='Winter'><Subject file='people/a.xml'/>"
      "</Model></ConverterConfig>";
  EXPECT_EQ(ParseConverterConfig(xml, "c.xml").subject_file, "people/a.xml");
  EXPECT_EQ(ParseConverterConfig(xml, "/x/c.xml").subject_file, "/x/people/a.xml");
  EXPECT_EQ(Parse("<Model><Subject file='/a.xml'/></Model>").subject_file, "/a.xml");
  EXPECT_EQ(Parse("").subject_file, "");
  EXPECT_THAT(ErrorOf("<Model><Subject/></Model>"), HasSubstr("<Subject> needs file=\"...\""));
  EXPECT_THAT(ErrorOf("<Model name='None'><Subject file='a'/></Model>"),
              HasSubstr("<Subject> needs <Model name=\"Winter\">"));
}

TEST(ConverterConfig, ErrorsNameFileLineAndWhatIsAllowed) {
  EXPECT_EQ(ErrorOf("<Model name='Summer'/>"),
            "c.xml:2: <Model>: name=\"Summer\" is not allowed; use Winter (scales the model by "
            "height and mass) or None (leaves it as it is)");
  EXPECT_EQ(ErrorOf("<Model nome='Winter'/>"),
            "c.xml:2: <Model>: unknown attribute nome; use name");
  EXPECT_EQ(ErrorOf("<Model>\n<Marker/></Model>"),
            "c.xml:3: unknown element <Marker> in <Model>; use Subject, MarkerMapping or Joints");
  EXPECT_THAT(ErrorOf("<Model/>\n<Model/>"), HasSubstr("c.xml:3: <Model> is already in line 2"));
  EXPECT_THAT(ErrorOf("<Model><MarkerMapping/></Model>"), HasSubstr("<MarkerMapping> is empty"));
  EXPECT_THAT(ErrorOf("<Model><Joints set='all'><Joint name='a'/></Joints></Model>"),
              HasSubstr("exclude each other"));
  EXPECT_THAT(ErrorOf("<Model><Joints><Joint/></Joints></Model>"),
              HasSubstr("c.xml:2: <Joint> needs name=\"...\""));
  EXPECT_THAT(ErrorOf("<Model><Joints><Joint name='a'/>\n<Joint name='a'/></Joints></Model>"),
              HasSubstr("c.xml:3: <Joint>: name=\"a\" is already in line 2"));
}

TEST(ConverterConfig, ALabelHasOneMarkerAMarkerCanHaveSubstitutes) {
  EXPECT_EQ(ErrorOf("<Model><MarkerMapping>\n<Mapping source='A' target='M'/>\n"
                    "<Mapping source='A' target='N'/>\n<Mapping source='B' target='M'/>\n"
                    "</MarkerMapping></Model>"),
            "c.xml:4: <Mapping>: source=\"A\" is already in line 3; keep one of them");
}

TEST(ConverterConfig, RefusesNoiseScalesOutsideTheirRange) {
  for (const char* scale : {"0", "-1", "101", "nan", "inf", "a", ""}) {
    EXPECT_THAT(ErrorOf(std::string("<Model><MarkerMapping><Mapping source='A' target='M' "
                                    "noiseScale='") +
                        scale + "'/></MarkerMapping></Model>"),
                HasSubstr("use a number from 0.01 to 100"))
        << scale;
  }
}

TEST(ConverterConfig, RefusesOtherFiles) {
  EXPECT_THAT([] { ParseConverterConfig("<Robot/>", "c.xml"); },
              ThrowsMessage<Error>(HasSubstr("c.xml:1: this is a <Robot> file")));
  EXPECT_THAT([] { ParseConverterConfig("<ConverterConfig/>", "c.xml"); },
              ThrowsMessage<Error>(HasSubstr("c.xml:1: <ConverterConfig> needs the name")));
  EXPECT_THAT([] { ReadConverterConfig("/no/such/file.xml"); },
              ThrowsMessage<Error>(HasSubstr("/no/such/file.xml")));
}

TEST(ConverterConfig, ItsTemplateIsAllDefaults) {
  double value = 0.005;
  SettingTable table;
  table.Add("Noise", "markerStandardDeviation_mm", &value, 1e-3, 0, 100, "of a marker");
  const ConverterConfig config =
      ParseConverterConfig(FormatConfigTemplate("S2KFConverter", table), "template");
  const ConverterConfig defaults;
  EXPECT_EQ(config.type, "S2KFConverter");
  EXPECT_EQ(config.model_processor, defaults.model_processor);
  EXPECT_EQ(config.marker_set, defaults.marker_set);
  EXPECT_EQ(config.joint_set, defaults.joint_set);
  ASSERT_EQ(config.plugin_elements.size(), 1u);
  EXPECT_EQ(*config.plugin_elements[0].FindAttribute("markerStandardDeviation_mm"), "5");
}

TEST(ResolveJoints, TakesAListInItsOrder) {
  EXPECT_THAT(ResolveJoints(Parse("<Model><Joints><Joint name='hip'/><Joint name='knee'/></Joints>"
                                  "</Model>"),
                            testing::StickModel()),
              ElementsAre(1, 0));
}

TEST(ResolveJoints, KnowsSets) {
  const KinematicModel model = testing::StickModel();
  ConverterConfig config;
  EXPECT_THAT(ResolveJoints(config, model), ElementsAre(0, 1));
  config.joint_set = "all";
  EXPECT_THAT(ResolveJoints(config, model), ElementsAre(0, 1));
  config.joint_set = "Upper";
  EXPECT_THAT(ResolveJoints(config, model), ElementsAre(1));
}

TEST(ResolveJoints, KnowsTheJointsOfKitsMotions) {
  const KinematicModel model = ReadMmmModel(testing::SourcePath("xml_config/models/mmm.xml"));
  const auto names = [&](const std::string& set) {
    ConverterConfig config;
    config.joint_set = set;
    std::vector<std::string> list;
    for (const int joint : ResolveJoints(config, model)) list.push_back(model.joint(joint).name);
    return list;
  };
  const std::vector<std::string> mmm44 = names("mmm44");
  ASSERT_EQ(mmm44.size(), 44u);
  EXPECT_EQ(mmm44[0], "BLNx_joint");
  EXPECT_EQ(mmm44[26], "LFx_joint");  // the order of KIT's 2.0 files
  EXPECT_EQ(mmm44[43], "RMrot_joint");
  EXPECT_EQ(names("auto"), mmm44);
  const std::vector<std::string> mmm40 = names("mmm40");
  ASSERT_EQ(mmm40.size(), 40u);
  EXPECT_EQ(mmm40[26], "RAx_joint");
  EXPECT_EQ(mmm40[39], "RWy_joint");
}

TEST(ResolveJoints, ErrorsNameEveryUnknownJointWithItsLine) {
  EXPECT_THAT(
      [] {
        ResolveJoints(Parse("<Model><Joints>\n<Joint name='nee'/>\n<Joint name='plate'/>"
                            "</Joints></Model>"),
                      testing::StickModel());
      },
      ThrowsMessage<Error>("c.xml:3: model stick has no joint \"nee\" (did you mean knee?)\n"
                           "c.xml:4: \"plate\" does not turn in model stick (it is fixed or "
                           "prismatic)"));
  EXPECT_THAT(
      [] { ResolveJoints(Parse("<Model><Joints set='mmm44'/></Model>"), testing::StickModel()); },
      ThrowsMessage<Error>(
          HasSubstr("c.xml:2: <Joints>: set=\"mmm44\" has no joint of model stick; "
                    "use auto, mmm44, mmm40, all or Upper")));
}

TEST(ResolveMarkerPairs, TakesTheConfigurationsOwnList) {
  ConverterConfig config;
  config.marker_pairs = {{"a", "MARKER_A"}};
  std::string name = "unchanged";
  const auto pairs = ResolveMarkerPairs(config, {{"a"}}, testing::StickModel(), &name);
  ASSERT_EQ(pairs.size(), 1u);
  EXPECT_EQ(pairs[0].source, "a");
  EXPECT_EQ(name, "");
}

TEST(ResolveMarkerPairs, ChoosesAmongTheShippedSets) {
  const KinematicModel model = ReadMmmModel(testing::SourcePath("xml_config/models/mmm.xml"));
  ConverterConfig config;
  std::string name;
  const auto pairs = ResolveMarkerPairs(config, {{"LAEL", "LAOL", "C7"}}, model, &name);
  EXPECT_EQ(name, "KIT");
  EXPECT_GE(pairs.size(), 53u);
  ResolveMarkerPairs(config, {{"LELB", "LFWT", "C7"}}, model, &name);
  EXPECT_EQ(name, "PluginGait");
  for (const char* set : {"KIT", "kit53"}) {
    config.marker_set = set;
    ResolveMarkerPairs(config, {{"LELB", "LFWT", "C7"}}, model, &name);
    EXPECT_EQ(name, "KIT");
  }
}

TEST(ResolveMarkerPairs, ReadsASetBesideTheConfiguration) {
  ConverterConfig config;
  config.file = testing::SourcePath("xml_config/marker_sets/c.xml");
  config.marker_set = "kit53.xml";
  std::string name;
  // The stick model has none of the set's markers.
  EXPECT_THAT(ResolveMarkerPairs(config, {{"C7"}}, testing::StickModel(), &name), IsEmpty());
  EXPECT_EQ(name, "KIT");
}

TEST(ResolveMarkerPairs, SaysWhichSetsThereAre) {
  ConverterConfig config = Parse("<Model>\n<MarkerMapping set='kit'/></Model>");
  config.marker_set = "kti53";
  EXPECT_THAT(
      [&] {
        std::string name;
        ResolveMarkerPairs(config, {{"C7"}}, testing::StickModel(), &name);
      },
      ThrowsMessage<Error>(HasSubstr("c.xml:3: <MarkerMapping>: there is no marker set \"kti53\" "
                                     "(did you mean kit53?)")));
}

}  // namespace
}  // namespace mmm_converter
