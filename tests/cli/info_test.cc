// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "common/convert/motion_converter.h"
#include "tests/cli/batch_manifest.h"
#include "tests/cli/program.h"
#include "tests/support/c3d_bytes.h"
#include "tests/support/shared_data.h"
#include "tests/support/test_plugins.h"

namespace mmm_converter {
namespace {

using ::testing::AllOf;
using testing::C3dBytes;
using testing::C3dSection;
using ::testing::ElementsAre;
using testing::Handstand;
using ::testing::HasSubstr;
using testing::RunProgram;
using ::testing::SizeIs;
using testing::SourcePath;

nlohmann::json InfoOf(const std::string& file) {
  const auto run = RunProgram({"info", file, "--json"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  return nlohmann::json::parse(run.out);
}

TEST(Info, Recording) {
  const auto json = InfoOf(Handstand());
  EXPECT_EQ(json["kind"], "recording");
  EXPECT_EQ(json["format"], "C3D");
  EXPECT_EQ(json["frames"], 675);
  EXPECT_EQ(json["rate_hz"], 100);
  EXPECT_EQ(json["first_frame"], 1);
  EXPECT_EQ(json["unit"], "mm");
  EXPECT_EQ(json["up_axis"], "+z");
  const auto& conversion = json["conversion"];
  EXPECT_TRUE(conversion["failure"].is_null());
  EXPECT_EQ(conversion["marker_set"], "KIT");
  EXPECT_EQ(conversion["markers_used"], 53);
  EXPECT_THAT(conversion["shown"], SizeIs(6));
  EXPECT_THAT(conversion["not_shown"], SizeIs(0));
  EXPECT_NEAR(conversion["height_m"], 1.8, 0.06);
  ASSERT_THAT(json["labels"], SizeIs(53));
  for (const auto& label : json["labels"]) {
    EXPECT_EQ(label["frames_seen"], 675);
    EXPECT_THAT(label["mean_position_m"], SizeIs(3));
  }
  const auto run = RunProgram({"info", Handstand()});
  EXPECT_THAT(run.out,
              AllOf(HasSubstr("675 at 100 Hz"), HasSubstr("labels     53"), HasSubstr("C7")));
}

TEST(Info, Model) {
  const auto json = InfoOf(SourcePath("xml_config/models/mmm.xml"));
  EXPECT_EQ(json["kind"], "model");
  EXPECT_NEAR(json["mass_kg"], 1, 1e-9);  // of the reference model; sums of 19 written figures
  EXPECT_THAT(json["markers"], SizeIs(53));
  const auto& joints = json["joints"];
  const auto knee = std::find_if(joints.begin(), joints.end(),
                                 [](const auto& joint) { return joint["name"] == "LKx_joint"; });
  ASSERT_NE(knee, joints.end());
  EXPECT_NEAR((*knee)["lower_rad"], -2.26893, 1e-9);
  EXPECT_EQ((*knee)["upper_rad"], 0);
  EXPECT_THAT(RunProgram({"info", SourcePath("xml_config/models/mmm.xml")}).out,
              AllOf(HasSubstr("LKx_joint"), HasSubstr("MARKER_C7"), HasSubstr("mass")));
}

TEST(Info, Motion) {
  const auto json = InfoOf(SourcePath("examples/handstand_true.xml"));
  EXPECT_EQ(json["kind"], "motion");
  ASSERT_THAT(json["motions"], SizeIs(1));
  const auto& motion = json["motions"][0];
  EXPECT_EQ(motion["frames"], 675);
  EXPECT_GE(motion["joints"].size(), 40u);
}

TEST(Info, ConfigurationAndPlugin) {
  const auto config = InfoOf(SourcePath("xml_config/converters/s2kf_paper.xml"));
  EXPECT_EQ(config["kind"], "configuration");
  EXPECT_EQ(config["converter"], "S2KFConverter");
  EXPECT_THAT(config["elements"], ElementsAre("Filter", "MotionModel", "Noise", "Start"));
  // What convert would say of it is said.
  const std::string file = testing::TestFolder() + "/config.xml";
  testing::WriteText(file, "<ConverterConfig type='S2KFConverter'>\n<Nose/></ConverterConfig>");
  const auto convert = RunProgram({"convert", testing::Handstand(), "-c", file});
  const auto info = RunProgram({"info", file});
  EXPECT_EQ(info.exit_code, 1);
  EXPECT_THAT(info.err, HasSubstr("config.xml:2: unknown element <Nose> (did you mean Noise?)"));
  EXPECT_EQ(info.err, convert.err);
  testing::WriteText(file, "<ConverterConfig type='NoConverter'><Nose/></ConverterConfig>");
  EXPECT_THAT(RunProgram({"info", file}).err, HasSubstr("its elements are not checked"));
  const auto plugin = InfoOf(testing::TestPlugin("test_converter"));
  EXPECT_EQ(plugin["kind"], "plugin");
  EXPECT_EQ(plugin["name"], "TestConverter");
  EXPECT_EQ(plugin["version"], kConverterInterfaceVersion);
}

TEST(InfoRealFiles, RealFiles) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const auto recording = InfoOf(testing::SharedData("recordings/whole_body/85_02.c3d"));
  EXPECT_EQ(recording["rate_hz"], 120);
  const auto motions =
      InfoOf(testing::SharedData("mmm/kit_bimanual_10hz/"
                                 "Peel_files_motions_3109_Peel1_cucumber_cb_07.xml"));
  EXPECT_GT(motions["motions"].size(), 1u);
}

TEST(Info, MarkerSet) {
  const auto json = InfoOf(SourcePath("xml_config/marker_sets/kit53.xml"));
  EXPECT_EQ(json["kind"], "marker set");
  EXPECT_EQ(json["name"], "KIT");
  EXPECT_GE(json["mappings"].size(), 53u);
  EXPECT_EQ(json["mappings"][0]["label"], "LFHD");
}

TEST(Info, SubjectAndPerson) {
  const std::string subject = testing::TestFolder() + "/anna.xml";
  testing::WriteText(subject,
                     "<Subject name='anna' model='MMM' height_m='1.7' mass_kg='60'><Segments>"
                     "<Segment name='LKx_joint' scale='1.1'/></Segments><Provenance program='p'>"
                     "<Recording name='walk.c3d' frames='7'/></Provenance></Subject>");
  auto json = InfoOf(subject);
  EXPECT_EQ(json["kind"], "subject");
  EXPECT_EQ(json["height_m"], 1.7);
  EXPECT_THAT(json["segments"], ElementsAre("LKx_joint"));
  EXPECT_THAT(json["recordings"], ElementsAre("walk.c3d"));
  const std::string person = testing::TestFolder() + "/1723.xml";
  testing::WriteText(person,
                     "<ModelProcessorConfig type='Winter'><Height>1.68</Height><Mass>62</Mass>"
                     "</ModelProcessorConfig>");
  json = InfoOf(person);
  EXPECT_EQ(json["kind"], "person");
  EXPECT_EQ(json["mass_kg"], 62);
  EXPECT_EQ(json["hand_length_m"], nullptr);
}

TEST(Info, OutputsOfAConversion) {
  const std::string& folder = testing::TestFolder();
  const auto run = RunProgram(testing::WithTestConverter(
      {"convert", Handstand(), "--height", "1.8", "--frames", "0:20", "-o", folder + "/m.xml",
       "--summary", folder + "/m.json", "--report", folder + "/m.html", "--export-csv",
       folder + "/m.csv", "--export-mot", folder + "/m.mot", "--export-trc", folder + "/m.trc"}));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(InfoOf(folder + "/m.xml")["kind"], "motion");
  EXPECT_EQ(InfoOf(folder + "/m.trc")["format"], "TRC");
  EXPECT_EQ(InfoOf(folder + "/m.csv")["rows"], 20);
  const auto mot = InfoOf(folder + "/m.mot");
  EXPECT_EQ(mot["rows"], 20);
  EXPECT_EQ(mot["columns"][0], "time");
  const auto summary = InfoOf(folder + "/m.json");
  EXPECT_EQ(summary["of"], "summary of a conversion");
  EXPECT_EQ(summary["members"]["frames"], 20);
  const auto page = InfoOf(folder + "/m.html");
  EXPECT_EQ(page["of"], "motions on their recordings");
  EXPECT_EQ(page["recordings"], 1);
}

TEST(Info, FilesOfABatch) {
  const std::string manifest = testing::WriteManifest(2, testing::QuickConverter());
  const std::string folder = testing::TestFolder() + "/out";
  const auto run = RunProgram({"batch", manifest, "-o", folder, "--reports", "none"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto json = InfoOf(manifest);
  EXPECT_EQ(json["kind"], "manifest");
  EXPECT_THAT(json["recordings"], SizeIs(2));
  const auto journal = InfoOf(folder + "/journal.jsonl");
  EXPECT_EQ(journal["kind"], "journal");
  EXPECT_EQ(journal["states"]["converted"], 2);
  const auto results = InfoOf(folder + "/results.jsonl");
  EXPECT_EQ(results["kind"], "results");
  EXPECT_EQ(results["recordings"], 2);
  EXPECT_EQ(InfoOf(folder + "/results.csv")["rows"], 2);
  EXPECT_EQ(InfoOf(folder + "/index.html")["of"], "the index of a batch");
}

// C3D files that can't be converted.

std::string Frames(const C3dBytes& bytes, const C3dSection& section) {
  std::string file = testing::TestFolder() + "/odd.c3d";
  testing::WriteText(file, bytes.File(section));
  return file;
}

TEST(Info, C3dWithoutAValidPoint) {
  const auto json = InfoOf(Frames({.points = 1, .frames = {{1, 2, 3, -1}, {4, 5, 6, -1}}},
                                  C3dSection().Group(1, "POINT").Texts(1, "LABELS", 2, "C7")));
  EXPECT_EQ(json["frames"], 2);
  EXPECT_EQ(json["can_be_converted"], false);
  EXPECT_THAT(json["failure"].get<std::string>(), HasSubstr("marked valid"));
  EXPECT_EQ(json["positions"]["marked_invalid"], 2);
  EXPECT_EQ(json["points"][0]["label"], "C7");
}

TEST(Info, C3dWithoutALabel) {
  const std::string file =
      Frames({.points = 2, .frames = {{1, 2, 3, 0, 4, 5, 6, 0}}}, C3dSection().Group(1, "POINT"));
  const auto json = InfoOf(file);
  EXPECT_EQ(json["stored"]["unlabelled"], 2);
  EXPECT_EQ(json["positions"]["seen"], 2);
  EXPECT_THAT(RunProgram({"info", file}).out, HasSubstr("convert    not as it is: "));
}

TEST(Info, C3dOfAnalogChannelsOnly) {
  const auto json = InfoOf(Frames(
      {.analog_words = 4, .analog_samples = 2, .frames = {{1, 2, 3, 4}}},
      C3dSection().Group(2, "ANALOG").Texts(2, "LABELS", 3, "EMGFz1").Word(2, "OFFSET", {65535})));
  EXPECT_EQ(json["frames"], 1);
  EXPECT_EQ(json["analog"]["rate_hz"], 200);
  EXPECT_EQ(json["analog"]["channels"][1]["label"], "Fz1");
  EXPECT_EQ(json["parameters"]["ANALOG"]["OFFSET"][0], -1);
}

TEST(InfoRealFiles, C3dOfSeveralSubjects) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const std::string file =
      testing::SharedData("recordings/synthetic/kit53_two_subjects_same_labels.c3d");
  EXPECT_THAT(InfoOf(file)["failure"].get<std::string>(), HasSubstr("several subjects: A, B"));
  EXPECT_THAT(InfoOf(file)["points"], SizeIs(106));
  EXPECT_EQ(RunProgram({"info", file, "--subject", "C"}).exit_code, 1);
}

TEST(InfoRealFiles, C3dContents) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const std::string file = testing::SharedData("forces/walking2.c3d");
  const auto json = InfoOf(file);
  EXPECT_THAT(json["analog"]["channels"], SizeIs(12));
  EXPECT_THAT(json["force_plates"], SizeIs(2));
  EXPECT_THAT(json["force_plates"][0]["corners"], SizeIs(4));
  EXPECT_EQ(json["parameters"]["POINT"]["USED"][0], json["points"].size());
  EXPECT_THAT(RunProgram({"info", file}).out,
              AllOf(HasSubstr("analog     12 channels at 2000 Hz"), HasSubstr("plates     2")));
  EXPECT_THAT(InfoOf(testing::SharedData("recordings/conformance/Eb015pr.c3d"))["events"],
              SizeIs(3));
}

TEST(InfoRealFiles, EveryRealFileIsDescribedOrRefused) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  for (const auto& entry : std::filesystem::recursive_directory_iterator(testing::SharedData(""))) {
    if (!entry.is_regular_file()) continue;
    const auto run = RunProgram({"info", entry.path().string(), "--json"});
    EXPECT_TRUE(run.exit_code == 0 || run.exit_code == 1) << entry.path() << run.err;
    const std::string ending = entry.path().extension().string();
    if (ending == ".c3d" || ending == ".trc") {
      EXPECT_EQ(run.exit_code, 0) << entry.path();
    }
    if (run.exit_code == 0) {
      EXPECT_TRUE(nlohmann::json::accept(run.out)) << entry.path();
    } else {
      EXPECT_THAT(run.err, HasSubstr("error: ")) << entry.path();
    }
  }
}

TEST(Info, CutFiles) {
  const std::string c3d = testing::ReadText(Handstand());
  const std::string file = testing::TestFolder() + "/cut.c3d";
  for (const std::size_t size : {1, 2, 132, 511, 512, 515, 1024, 2000, 4000, 40000}) {
    testing::WriteText(file, c3d.substr(0, size));
    const auto run = RunProgram({"info", file});
    EXPECT_TRUE(run.exit_code == 0 || run.exit_code == 1) << size << run.err;
  }
  for (const char* text :
       {"{", "{\"id\":", "<Batch", "<Subject/>", "<MarkerSet/>", "time_s,root_x_mm", "Coordinates",
        "<MMM", "{\"id\":\"a\",\"state\":1}\n[]\n"}) {
    testing::WriteText(file, text);
    const auto run = RunProgram({"info", file});
    EXPECT_TRUE(run.exit_code == 0 || run.exit_code == 1) << text << run.err;
  }
}

TEST(Info, OtherFilesAreRefused) {
  const auto missing = RunProgram({"info", "/no/such/file"});
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_THAT(missing.err, HasSubstr("/no/such/file"));
  testing::WriteText(testing::TestFolder() + "/page.xml", "<html/>");
  const auto page = RunProgram({"info", testing::TestFolder() + "/page.xml"});
  EXPECT_EQ(page.exit_code, 1);
  EXPECT_THAT(page.err, HasSubstr("a web page, but none of this program's"));
  testing::WriteText(testing::TestFolder() + "/other.xml", "<Robot2/>");
  EXPECT_THAT(RunProgram({"info", testing::TestFolder() + "/other.xml"}).err,
              AllOf(HasSubstr("with the root <Robot2>"), HasSubstr("marker sets")));
  EXPECT_EQ(RunProgram({"info", SourcePath("LICENSE")}).exit_code, 1);
  EXPECT_EQ(page.out, "");
}

}  // namespace
}  // namespace mmm_converter
