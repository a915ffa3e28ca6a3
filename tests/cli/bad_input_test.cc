// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "common/io/c3d/c3d_writer.h"
#include "common/motion/marker_sequence.h"
#include "tests/cli/program.h"
#include "tests/support/scoped_environment.h"
#include "tests/support/shared_data.h"
#include "tests/support/test_plugins.h"

namespace mmm_converter {
namespace {

using ::testing::AllOf;
using testing::Handstand;
using ::testing::HasSubstr;
using testing::ReadText;
using testing::RunProgram;
using testing::SourcePath;
using ::testing::StartsWith;
using testing::TestFolder;
using testing::WriteText;

std::set<std::string> Names(const std::string& folder) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    names.insert(entry.path().filename());
  }
  return names;
}

// Fails with one line, exit code 1 or 2, and leaves an existing output as it was.
void ExpectRefused(std::vector<std::string> arguments, const std::string& message) {
  const std::string output = TestFolder() + "/out.xml";
  WriteText(output, "as it was");
  const std::set<std::string> before = Names(TestFolder());
  arguments.insert(arguments.begin(), "convert");
  arguments.insert(arguments.end(), {"-o", output, "--summary", TestFolder() + "/summary.json"});
  const auto run = RunProgram(arguments);
  EXPECT_TRUE(run.exit_code == 1 || run.exit_code == 2) << run.exit_code;
  EXPECT_EQ(run.out, "");
  EXPECT_THAT(run.err, AllOf(StartsWith("error: "), HasSubstr(message)));
  EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
  EXPECT_EQ(ReadText(output), "as it was");
  EXPECT_EQ(Names(TestFolder()), before);
}

// As the sample, with other labels or gaps.
std::string WriteRecording(const std::vector<std::string>& labels, int num_seen) {
  MarkerSequence markers(labels, 200, 100, 0);
  for (int k = 0; k < markers.num_frames(); ++k) {
    for (int i = 0; i < num_seen; ++i) markers.frame(k).col(i) = Eigen::Vector3d(0.1 * i, 0.5, 1);
  }
  std::string file = TestFolder() + "/recording.c3d";
  WriteC3d(file, markers);
  return file;
}

std::string ModelWith(const std::string& old_text, const std::string& new_text) {
  std::string xml = ReadText(SourcePath("xml_config/models/mmm.xml"));
  const std::size_t place = xml.find(old_text);
  EXPECT_NE(place, std::string::npos);
  xml.replace(place, old_text.size(), new_text);
  std::string file = TestFolder() + "/model.xml";
  WriteText(file, xml);
  return file;
}

std::string ConfigWith(const std::string& inside) {
  std::string file = TestFolder() + "/config.xml";
  WriteText(file, "<ConverterConfig type='S2KFConverter'>\n" + inside + "\n</ConverterConfig>\n");
  return file;
}

TEST(BadInput, NoSuchFile) {
  ExpectRefused({TestFolder() + "/nothing.c3d", "--height", "1.8"}, "nothing.c3d: no such file");
}

TEST(BadInput, AFolder) { ExpectRefused({TestFolder(), "--height", "1.8"}, TestFolder()); }

TEST(BadInput, EmptyFile) {
  WriteText(TestFolder() + "/empty.c3d", "");
  ExpectRefused({TestFolder() + "/empty.c3d", "--height", "1.8"}, "empty.c3d");
}

TEST(BadInput, TextNamedC3d) {
  WriteText(TestFolder() + "/notes.c3d", "These are my notes of the session.\n");
  ExpectRefused({TestFolder() + "/notes.c3d", "--height", "1.8"}, "notes.c3d");
}

TEST(BadInput, TruncatedFile) {
  const std::string whole = ReadText(Handstand());
  for (const std::size_t size : {2u, 100u, 512u, 700u}) {
    WriteText(TestFolder() + "/cut.c3d", whole.substr(0, size));
    ExpectRefused({TestFolder() + "/cut.c3d", "--height", "1.8"}, "cut.c3d");
  }
}

TEST(BadInput, NoKnownLabel) {
  const std::string recording = WriteRecording({"X1", "X2", "X3", "X4"}, 4);
  ExpectRefused({recording, "--height", "1.8"}, "X1, X2, X3, X4");
  ExpectRefused({recording, "--height", "1.8"}, recording + ": no marker set");
  ExpectRefused({recording, "--height", "1.8", "-c",
                 ConfigWith("<Model><MarkerMapping><Mapping source='C7' target='MARKER_C7'/>"
                            "</MarkerMapping></Model>")},
                recording + ": no label of the recording is mapped: it has X1, X2, X3, X4");
}

TEST(BadInput, FewerThanThreeMarkers) {
  ExpectRefused({WriteRecording({"C7", "CLAV", "STRN", "T10"}, 2), "--height", "1.8"}, "marker");
}

TEST(BadInput, Height) {
  for (const char* height : {"17.5", "0", "0.3", "175"}) {
    ExpectRefused({Handstand(), "--height", height}, "height");
  }
}

TEST(BadInput, CrossedLimits) {
  const std::string model =
      ModelWith("<Limits lo=\"-10\" hi=\"10\"", "<Limits lo=\"10\" hi=\"-10\"");
  ExpectRefused({Handstand(), "--height", "1.8", "--model", model}, "model.xml:");
}

TEST(BadInput, UnknownJoint) {
  const std::string config =
      ConfigWith("<Model><Joints><Joint name='LKz_joint'/></Joints></Model>");
  ExpectRefused({Handstand(), "--height", "1.8", "-c", config}, "config.xml:2: model");
}

TEST(BadInput, UnknownSetting) {
  ExpectRefused({Handstand(), "--height", "1.8", "-c", ConfigWith("<Filter sample='93'/>")},
                "config.xml:2: <Filter>: unknown attribute sample (did you mean samples?)");
  ExpectRefused({Handstand(), "--height", "1.8", "-c", ConfigWith("<Noise><X/></Noise>")},
                "config.xml:2: <X> can't be inside <Noise>");
  ExpectRefused({Handstand(), "--height", "1.8", "-c", Handstand()}, "handstand.c3d");
}

TEST(BadInput, UnknownMarkerInMapping) {
  ExpectRefused({Handstand(), "--height", "1.8", "-c",
                 ConfigWith("<Model><MarkerMapping><Mapping source='C7' target='MARKER_C8'/>"
                            "</MarkerMapping></Model>")},
                "MARKER_C8");
}

TEST(BadInput, Plugins) {
  ExpectRefused({Handstand(), "--height", "1.8", "--plugin", SourcePath("LICENSE")},
                "can't be loaded as a shared library");
  ExpectRefused({Handstand(), "--height", "1.8", "--plugin", testing::TestPlugin("old_version")},
                "interface version");
  ExpectRefused({Handstand(), "--height", "1.8", "--converter", "NoConverter"},
                "there is no converter \"NoConverter\"");
}

TEST(BadInput, AFaultyPluginIsNamed) {
  const std::string plugin = testing::TestPlugin("faulty_converter");
  for (const char* fault : {"null", "joint", "int", "residuals", "verdict", "result angles"}) {
    const testing::ScopedEnvironment environment("MMM_CONVERTER_TEST_FAULT", fault);
    ExpectRefused({Handstand(), "--height", "1.8", "--plugin", plugin},
                  plugin + ": the plugin is faulty: ");
  }
}

TEST(BadInput, ARateThatCannotBe) {
  for (const char* rate : {"1e-300", "0.5", "1e300"}) {
    ExpectRefused({Handstand(), "--height", "1.8", "--rate", rate},
                  "give frames a second from 1 to 100000");
  }
}

TEST(BadInput, TwoOutputsAreOneFileByALinkToNothing) {
  std::filesystem::create_symlink("o.xml", TestFolder() + "/r.html");
  const auto run = RunProgram({"convert", Handstand(), "--height", "1.8", "-o",
                               TestFolder() + "/o.xml", "--report", TestFolder() + "/r.html"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("r.html: is to hold two outputs"));
  EXPECT_EQ(Names(TestFolder()), std::set<std::string>{"r.html"});
}

TEST(BadInput, ControlCharactersOfAFileAreNotPassedOn) {
  // As UTF-8, as a terminal of 8 bits has them, and in a file's name.
  const std::string name =
      "me\x1B]0;owned\x07\xC2\x9B"
      "2J\x9B"
      "2J\xE9";
  const std::string file = TestFolder() + "/" + name + ".c3d";
  std::filesystem::rename(WriteRecording({name + ":A", name + ":B", name + ":C"}, 3), file);
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"info", file}, {"info", "--json", file}, {"convert", file}}) {
    const auto run = RunProgram(words);
    EXPECT_EQ((run.out + run.err).find_first_of("\x1B\x07\x9B"), std::string::npos)
        << run.out << run.err;
  }
  EXPECT_THAT(RunProgram({"info", file}).out, HasSubstr("me\\x1B]0;owned\\x07\\x9B2J\\x9B2J\xE9"));
}

TEST(BadInput, AModelThatAMotionNamesIsSaidToBeNamedByIt) {
  const std::string motion = TestFolder() + "/walk.xml";
  WriteText(motion,
            "<MMM><Motion name='x'><Model><File>../../../../../../../../etc/passwd</File></Model>"
            "<ModelProcessorConfig type='Winter'><Height>1.8</Height></ModelProcessorConfig>"
            "<JointOrder><Joint name='a'/></JointOrder><MotionFrames><MotionFrame><Timestep>0"
            "</Timestep><RootPosition>0 0 0</RootPosition><RootRotation>0 0 0</RootRotation>"
            "<JointPosition>0</JointPosition></MotionFrame></MotionFrames></Motion></MMM>");
  const auto run = RunProgram({"check-dynamics", motion});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("walk.xml: names the model ../../../../../../../../etc/passwd, "
                                 "which can't be read (--model gives another): "));
}

TEST(BadInput, AWorkingFolderThatIsGone) {
  const std::string before = std::filesystem::current_path();
  std::filesystem::create_directory(TestFolder() + "/gone");
  std::filesystem::current_path(TestFolder() + "/gone");
  std::filesystem::remove(TestFolder() + "/gone");
  const auto run = RunProgram({"convert", Handstand(), "--height", "1.8", "-o", "out.xml"});
  std::filesystem::current_path(before);
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("the working folder is not there any more; change into another"));
}

TEST(BadInput, TooLittleMemory) {
#if defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "the sanitizer reserves terabytes of addresses";
#endif
  const std::string file = TestFolder() + "/large.xml";
  WriteText(file, "<MMM><Motion>");
  std::filesystem::resize_file(file, std::uintmax_t{3} << 30);
  rlimit old_limit{};
  ASSERT_EQ(getrlimit(RLIMIT_AS, &old_limit), 0);
  rlimit limit = old_limit;
  limit.rlim_cur = 600 << 20;
  ASSERT_EQ(setrlimit(RLIMIT_AS, &limit), 0);
  const auto run = RunProgram({"info", file});
  setrlimit(RLIMIT_AS, &old_limit);
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, StartsWith("error: there is not enough memory for this; close"));
}

TEST(BadInput, Frames) {
  ExpectRefused({Handstand(), "--height", "1.8", "--frames", "5:5"}, "--frames 5:5");
  ExpectRefused({Handstand(), "--height", "1.8", "--frames", "675:"}, "has no frame");
}

TEST(BadInput, OverridesThatDoNotExist) {
  ExpectRefused({Handstand(), "--height", "1.8", "--unit", "furlong"}, "furlong");
  ExpectRefused({Handstand(), "--height", "1.8", "--up", "w"}, "\"w\"");
  ExpectRefused({Handstand(), "--height", "1.8", "--subject", "nobody"}, "nobody");
}

TEST(BadInput, OutputThatCannotBeWritten) {
  const auto run =
      RunProgram(testing::WithTestConverter({"convert", Handstand(), "--height", "1.8", "--frames",
                                             ":3", "-o", TestFolder() + "/no/such/folder/o.xml"}));
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("/no/such/folder"));
}

TEST(BadInput, TheRecordingItselfIsNeverOverwritten) {
  const std::string input = TestFolder() + "/walk.c3d";
  std::filesystem::copy_file(Handstand(), input);
  const auto run = RunProgram({"convert", input, "--height", "1.8", "-o", input});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("is the recording itself"));
  EXPECT_EQ(ReadText(input), ReadText(Handstand()));
}

}  // namespace
}  // namespace mmm_converter
