// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "common/io/mmm/mmm_motion.h"
#include "tests/cli/program.h"
#include "tests/support/shared_data.h"
#include "tests/support/test_plugins.h"

namespace mmm_converter {
namespace {

using ::testing::AllOf;
using ::testing::EndsWith;
using testing::Handstand;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using testing::ReadText;
using testing::RunProgram;
using ::testing::SizeIs;
using testing::TestFolder;
using testing::WithTestConverter;
using testing::WriteText;

// An MMM 2.0 file with the markers of the sample, and an object's motion behind the human's.
std::string MakeRecordingOfTwo() {
  std::string file = TestFolder() + "/two.xml";
  const auto run =
      RunProgram(WithTestConverter({"convert", Handstand(), "--height", "1.8", "--frames", ":12",
                                    "--motion", "1723", "-o", file}));
  EXPECT_EQ(run.exit_code, 0) << run.err;
  std::string xml = ReadText(file);
  const std::size_t end = xml.rfind("</MMM>");
  xml.insert(end,
             "<Motion name=\"box\" type='object'><!-- kept --><Model path=\"box.xml\"/><Sensors/>"
             "<Unknown a='1'/></Motion>\n");
  WriteText(file, xml);
  return file;
}

TEST(Convert, WritesBesideTheInputUnlessTold) {
  const std::string input = TestFolder() + "/walk.c3d";
  std::filesystem::copy_file(Handstand(), input);
  const auto run =
      RunProgram(WithTestConverter({"convert", input, "--height", "1.8", "--frames", "10:30"}));
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const MmmMotionFile file = ReadMmmMotionFile(TestFolder() + "/walk_mmm.xml");
  ASSERT_THAT(file.motions, SizeIs(1));
  const MmmMotion& motion = file.motions.front();
  EXPECT_EQ(file.version, "2.0");
  EXPECT_EQ(motion.name, "walk");
  EXPECT_EQ(motion.size.height, 1.8);
  EXPECT_EQ(motion.size.mass, 70);
  EXPECT_EQ(motion.trajectory.num_frames(), 20);
  EXPECT_THAT(motion.trajectory.joint_names, SizeIs(44));
  EXPECT_EQ(motion.markers.num_labels(), 53);
  EXPECT_NEAR(motion.trajectory.first_time, 0.1, 1e-9);  // 9 decimals are written
}

TEST(Convert, SummaryIsForPeopleOnStdout) {
  const auto run =
      RunProgram(WithTestConverter({"convert", Handstand(), "--height", "1.8", "--frames", ":20",
                                    "-o", TestFolder() + "/o.xml"}));
  EXPECT_THAT(run.out, AllOf(HasSubstr("20 frames at 100 Hz"), HasSubstr("1.8 m (given)"),
                             HasSubstr("70 kg (assumed)"), HasSubstr("53 used"),
                             HasSubstr("marker set KIT"), HasSubstr("TestConverter")));
  EXPECT_THAT(run.err, Not(HasSubstr("frames")));  // no progress bar without a terminal
}

TEST(Convert, SummaryAsJsonHasEveryFigure) {
  const std::string file = TestFolder() + "/summary.json";
  RunProgram(
      WithTestConverter({"convert", Handstand(), "--height", "1.8", "--mass", "81", "--frames",
                         ":20", "-o", TestFolder() + "/o.xml", "--summary", file}));
  const auto json = nlohmann::json::parse(ReadText(file));
  EXPECT_EQ(json["input"]["file"], Handstand());
  EXPECT_EQ(json["input"]["format"], "C3D");
  EXPECT_EQ(json["input"]["up_axis"], "+z");
  EXPECT_EQ(json["frames"], 20);
  EXPECT_EQ(json["rate_hz"], 100);
  EXPECT_EQ(json["person"]["height_m"], 1.8);
  EXPECT_EQ(json["person"]["height_source"], "given");
  EXPECT_EQ(json["person"]["mass_kg"], 81);
  EXPECT_EQ(json["converter"], "TestConverter");
  EXPECT_THAT(json["joints"], SizeIs(44));
  EXPECT_THAT(json["markers"]["used"], SizeIs(53));
  EXPECT_THAT(json["markers"]["ignored"], IsEmpty());
  const auto& first = json["markers"]["used"][0];
  EXPECT_EQ("MARKER_" + first["label"].get<std::string>(), first["marker"]);
  EXPECT_EQ(first["frames_seen"], 20);
  for (const auto& distance : {json["distance_mm"], first["distance_mm"]}) {
    EXPECT_GT(distance["mean"], 0);
    EXPECT_GE(distance["p95"], distance["mean"]);
    EXPECT_GE(distance["max"], distance["p95"]);
  }
  EXPECT_EQ(json["frames_with_missing_markers"], 0);
  EXPECT_EQ(json["frames_not_converged"], 0);
  EXPECT_GT(json["ms_per_frame"]["median"], 0);
  EXPECT_GE(json["ms_per_frame"]["p99"], json["ms_per_frame"]["median"]);
}

TEST(Convert, TheSameCallGivesTheSameBytes) {
  const auto convert = [](const std::string& name) {
    const auto run = RunProgram({"convert", Handstand(), "--height", "1.8", "--frames", ":30", "-o",
                                 TestFolder() + "/" + name});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return ReadText(TestFolder() + "/" + name);
  };
  EXPECT_EQ(convert("a.xml"), convert("b.xml"));
}

TEST(Convert, WritesMmm1OnRequest) {
  const std::string file = TestFolder() + "/o.xml";
  const auto run = RunProgram(WithTestConverter({"convert", Handstand(), "--height", "1.8",
                                                 "--frames", ":5", "--format", "1.0", "-o", file}));
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const MmmMotionFile motions = ReadMmmMotionFile(file);
  EXPECT_EQ(motions.version, "1.0");
  EXPECT_EQ(motions.motions.at(0).trajectory.num_frames(), 5);
}

TEST(Convert, ModelPathIsRelativeToTheMotionOrAsTold) {
  const std::string model = TestFolder() + "/models/m.xml";
  std::filesystem::create_directories(TestFolder() + "/models");
  std::filesystem::create_directories(TestFolder() + "/motions");
  std::filesystem::copy_file(testing::SourcePath("xml_config/models/mmm.xml"), model);
  const std::string file = TestFolder() + "/motions/o.xml";
  std::vector<std::string> call = WithTestConverter(
      {"convert", Handstand(), "--height", "1.8", "--frames", ":5", "--model", model, "-o", file});
  RunProgram(call);
  EXPECT_EQ(ReadMmmMotionFile(file).motions.at(0).model_path, "../models/m.xml");
  call.insert(call.end(), {"--model-path", "Winter/mmm.xml"});
  RunProgram(call);
  EXPECT_EQ(ReadMmmMotionFile(file).motions.at(0).model_path, "Winter/mmm.xml");
}

TEST(Convert, KeepsTheOtherMotionsOfAnMmmFileInPlace) {
  const std::string file = MakeRecordingOfTwo();
  const std::string before = ReadText(file);
  const auto run = RunProgram(WithTestConverter(
      {"convert", file, "--motion", "1723", "--frames", "2:", "--mass", "62", "-o", file}));
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const std::string after = ReadText(file);
  const std::string other = before.substr(before.find("<Motion name=\"box\""));
  EXPECT_THAT(after, EndsWith(other));
  const MmmMotionFile motions = ReadMmmMotionFile(file);
  ASSERT_THAT(motions.motions, SizeIs(2));
  EXPECT_EQ(motions.motions[0].size.mass, 62);
  EXPECT_EQ(motions.motions[0].size.height, 1.8);
  EXPECT_EQ(motions.motions[0].trajectory.num_frames(), 10);
  EXPECT_EQ(motions.motions[0].markers.num_frames(), 12);  // sensors that are not replaced stay
}

TEST(Convert, TakesMmmMotionConvertersOptions) {
  const std::string file = MakeRecordingOfTwo();
  const std::string config = TestFolder() + "/NloptConverterVicon2MMM_WinterConfig.xml";
  WriteText(
      config,
      "<?xml version='1.0' encoding='UTF-8'?>\n<ConverterConfig type='NloptConverter'>\n"
      "<Model name='Winter'><MarkerMapping>"
      "<Mapping source=\"C7\" target=\"MARKER_C7\"/><Mapping source=\"L3\" target=\"MARKER_L3\"/>"
      "<Mapping source=\"CLAV\" target=\"MARKER_CLAV\"/></MarkerMapping></Model>\n"
      "<Strategy/></ConverterConfig>");
  const std::string person = TestFolder() + "/1723.xml";
  WriteText(person,
            "<ModelProcessorConfig type='Winter'><Height>1.79</Height><Mass>78</Mass>"
            "<HandLength>18.9</HandLength></ModelProcessorConfig>");
  const std::vector<std::string> call = {"--inputMotion",
                                         file,
                                         "--motionName",
                                         "1723",
                                         "--converterConfigFile",
                                         config,
                                         "--outputModelFile",
                                         testing::SourcePath("xml_config/models/mmm.xml"),
                                         "--outputModelProcessorConfigFile",
                                         person,
                                         "--outputMotion",
                                         file};
  for (const bool with_command : {true, false}) {
    std::vector<std::string> arguments = WithTestConverter(call);
    if (with_command) arguments.insert(arguments.begin(), "convert");
    const auto run = RunProgram(arguments);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.out, AllOf(HasSubstr("3 used"), HasSubstr("1.79 m (" + person + ")")));
    EXPECT_THAT(run.err, HasSubstr("is a configuration for NloptConverter"));
    const MmmMotion motion = ReadMmmMotionFile(file).motions.at(0);
    EXPECT_EQ(motion.name, "1723");
    EXPECT_EQ(motion.size.height, 1.79);
    EXPECT_EQ(motion.size.mass, 78);
    EXPECT_NEAR(motion.size.hand_length.value(), 0.189, 1e-12);  // cm in the file
  }
}

TEST(Convert, ConfigurationAndConverterMustFit) {
  const std::string config = TestFolder() + "/c.xml";
  WriteText(config,
            "<ConverterConfig type='TestConverter'><Test heightOffset_mm='500'/>"
            "</ConverterConfig>");
  const std::string low = TestFolder() + "/low.xml";
  const std::string high = TestFolder() + "/high.xml";
  std::vector<std::string> call =
      WithTestConverter({"convert", Handstand(), "--height", "1.8", "--frames", ":3"});
  call.insert(call.end(), {"-o", low});
  EXPECT_EQ(RunProgram(call).exit_code, 0);
  call.back() = high;
  call.insert(call.end(), {"-c", config});
  EXPECT_EQ(RunProgram(call).exit_code, 0);
  const auto root = [](const std::string& file) {
    return ReadMmmMotionFile(file).motions.at(0).trajectory.postures.at(0).position;
  };
  EXPECT_NEAR(root(high).z() - root(low).z(), 0.5, 1e-6);  // 0.1 micrometres are written
  const auto run = RunProgram(
      {"convert", Handstand(), "--height", "1.8", "-c", config, "--converter", "S2KFConverter"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("is a configuration for TestConverter, not for S2KFConverter"));
}

TEST(Convert, HeightIsEstimatedWhereNobodyGivesIt) {
  const std::string file = TestFolder() + "/o.xml";
  const auto run =
      RunProgram(WithTestConverter({"convert", Handstand(), "--frames", ":100", "-o", file}));
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("estimated from"));
  // The sample's person is 1.8 m; its marker offsets of 28 mm leave a few per cent.
  EXPECT_NEAR(ReadMmmMotionFile(file).motions.at(0).size.height.value(), 1.8, 0.1);
}

TEST(Convert, SaysThatMmm1KeepsOneMotionOnly) {
  const std::string file = MakeRecordingOfTwo();
  const auto run = RunProgram(WithTestConverter(
      {"convert", file, "--motion", "1723", "--format", "1.0", "-o", TestFolder() + "/o.xml"}));
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("has 2 motions; the output has the converted one only"));
  EXPECT_THAT(ReadMmmMotionFile(TestFolder() + "/o.xml").motions, SizeIs(1));
}

TEST(ConvertRealFiles, RealKitFileInPlace) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const std::string file = TestFolder() + "/peel.xml";
  WriteText(file,
            ReadText(testing::SharedData("mmm/kit_bimanual_10hz/Peel_files_motions_3109_Peel1_"
                                         "cucumber_cb_07.xml")));
  const MmmMotionFile before = ReadMmmMotionFile(file);
  ASSERT_GT(before.motions.size(), 1u);
  const auto run = RunProgram({"convert", file, "--motion", "true_1723", "-o", file});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const MmmMotionFile after = ReadMmmMotionFile(file);
  ASSERT_EQ(after.motions.size(), before.motions.size());
  int changed = 0;
  for (std::size_t i = 0; i < before.motions.size(); ++i) {
    const auto& a = before.motions[i];
    const auto& b = after.motions[i];
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.size.height, b.size.height);
    EXPECT_EQ(a.markers.num_frames(), b.markers.num_frames());
    if (a.model_path != b.model_path) ++changed;
  }
  EXPECT_EQ(changed, 1);  // the converted one names the shipped model
}

TEST(Convert, S2kfConverterIsTheDefault) {
  const std::string file = TestFolder() + "/o.xml";
  const std::string json_file = TestFolder() + "/o.json";
  const auto run = RunProgram({"convert", Handstand(), "--height", "1.8", "--frames", ":60", "-o",
                               file, "--summary", json_file});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const auto json = nlohmann::json::parse(ReadText(json_file));
  EXPECT_EQ(json["converter"], "S2KFConverter");
  EXPECT_THAT(json["configuration"], EndsWith("converters/s2kf_default.xml"));
  EXPECT_LT(json["distance_mm"]["mean"], 45);  // the sample's offsets leave some 38 mm
}

}  // namespace
}  // namespace mmm_converter
