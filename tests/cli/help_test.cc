// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "common/math/instruction_set.h"
#include "tests/cli/program.h"
#include "tests/support/shared_data.h"
#include "tests/support/test_plugins.h"

namespace mmm_converter {
namespace {

using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using testing::RunProgram;
using ::testing::StartsWith;

TEST(Help, IsPrintedWithoutArgumentsToo) {
  const auto run = RunProgram({});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.out, AllOf(HasSubstr("convert"), HasSubstr("print-config"), HasSubstr("Examples"),
                             HasSubstr("Exit codes")));
  EXPECT_EQ(run.err, "");
  EXPECT_EQ(RunProgram({"--help"}).out, run.out);
  EXPECT_EQ(RunProgram({"help"}).out, run.out);
  EXPECT_EQ(RunProgram({"help", "live"}).out, RunProgram({"live", "--help"}).out);
}

TEST(Help, EveryCommandHasOneWithExamples) {
  for (const char* command :
       {"calibrate", "check-dynamics", "compare", "convert", "evaluate", "export-poses",
        "export-urdf", "help", "info", "label", "learn-markers", "live", "print-config", "report",
        "retarget", "serve"}) {
    const auto run = RunProgram({command, "--help"});
    EXPECT_EQ(run.exit_code, 0);
    EXPECT_THAT(run.out, AllOf(StartsWith(std::string("MMMConverterS2KF ") + command),
                               HasSubstr("Examples")));
    EXPECT_EQ(run.err, "");
  }
}

int Columns(const std::string& line) {
  return static_cast<int>(std::count_if(line.begin(), line.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0) != 0x80;  // UTF-8: not a letter's further byte
  }));
}

TEST(Help, NoLineIsWiderThan100Columns) {
  for (const char* command :
       {"help", "batch", "calibrate", "check-dynamics", "compare", "convert", "evaluate",
        "export-poses", "export-urdf", "help", "info", "label", "learn-markers", "live",
        "print-config", "report", "retarget", "serve"}) {
    std::istringstream help(RunProgram({command, "--help"}).out);
    for (std::string line; std::getline(help, line);) EXPECT_LE(Columns(line), 100) << line;
  }
}

TEST(Help, ConvertSaysWhatItsExportsHold) {
  EXPECT_THAT(RunProgram({"convert", "--help"}).out,
              AllOf(HasSubstr("--export-csv FILE"), HasSubstr("where postures are smoothed"),
                    HasSubstr("--export-trc FILE"), HasSubstr("y up"), HasSubstr("LABEL_model"),
                    HasSubstr("--export-mot FILE"), HasSubstr("degrees"),
                    HasSubstr("--export-poses FILE"), HasSubstr("--export-bvh FILE")));
}

TEST(Help, VersionIsPrinted) {
  EXPECT_THAT(RunProgram({"--version"}).out, StartsWith("MMMConverterS2KF 1."));
  EXPECT_EQ(RunProgram({"info", "--version"}).out, RunProgram({"--version"}).out);
}

TEST(Help, VersionSaysWithWhatTheProgramWasBuilt) {
  const std::string version = RunProgram({"--version"}).out;
  EXPECT_THAT(version, ContainsRegex("\nbuilt by [A-Za-z]+ [0-9.]+, with(out)? check-dyn"));
  EXPECT_THAT(version, ContainsRegex("\nwith ([-A-Za-z0-9]+ [0-9]+\\.[0-9.]+, )*[-A-Za-z0-9]+ "
                                     "[0-9]+\\.[0-9.]+\n$"));
  for (const char* library :
       {"Boost 1.", "Eigen 3.", "fmt ", "nlohmann-json 3.", "oneTBB 20", "spdlog ", "assimp 5",
        "tinyxml2 ", "urdfdom ", "xxHash 0.", "ZeroMQ 4."}) {
    EXPECT_THAT(version, HasSubstr(library));
  }
}

TEST(Help, InstructionSetIsShownAndCanBeChosen) {
  const std::string fastest = ToString(SupportedInstructionSets().back());
  EXPECT_THAT(RunProgram({"info", "--version"}).out, HasSubstr("instruction set " + fastest));
  for (const InstructionSet set : SupportedInstructionSets()) {
    const auto run =
        RunProgram({"info", "--version"}, {{"MMM_CONVERTER_INSTRUCTION_SET", ToString(set)}});
    EXPECT_THAT(run.out, HasSubstr("instruction set " + ToString(set)));
  }
  const auto run =
      RunProgram({"info", testing::Handstand()}, {{"MMM_CONVERTER_INSTRUCTION_SET", "sse9"}});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("MMM_CONVERTER_INSTRUCTION_SET=\"sse9\""));
  EXPECT_THAT(run.err, HasSubstr("baseline"));
}

struct Misuse {
  std::vector<std::string> arguments;
  std::string message;
};

TEST(Usage, WhatIsNotUnderstoodIsExitCode2WithAHint) {
  const std::vector<Misuse> misuses = {
      {{"covnert"}, "unknown command \"covnert\" (did you mean convert?)"},
      {{"fly"},
       "unknown command \"fly\"; use convert, batch, calibrate, check-dynamics, compare, evaluate, "
       "export-poses, export-urdf, help, info, label, learn-markers, live, print-config, report, "
       "retarget or serve"},
      {{"convert", "walk.c3d", "--heigth", "1.8"},
       "unknown option --heigth (did you mean --height?)"},
      {{"convert", "walk.c3d", "--zzzzzz"}, "unknown option --zzzzzz; see"},
      {{"convert"}, "convert: which recording?"},
      {{"calibrate"}, "calibrate: which recordings?"},
      {{"calibrate", "a.c3d", "--subject-file", "s.xml"}, "unknown option --subject-file"},
      {{"convert", "a.c3d", "--self-calibrate", "--subject-file", "s.xml"}, "use one"},
      {{"convert", "a.c3d", "--subject-out", "s.xml"}, "--subject-out needs --self-calibrate"},
      {{"export-poses", "a.xml"}, "export-poses: which motion, and which file"},
      {{"export-poses", "a.xml", "-o", "a.txt"}, "a name that ends with .npz or .csv"},
      {{"export-poses", "a.xml", "b.xml", "-o", "a.npz"}, "name a folder"},
      {{"export-poses", "a.xml", "-o", "a.npz", "--points", "kit22"},
       "use kit21, kit44, all or none"},
      {{"check-dynamics"}, "check-dynamics: which motion?"},
      {{"check-dynamics", "a.xml", "--low-pass", "-1"},
       "--low-pass: \"-1\" is not allowed; give hertz from 0"},
      {{"compare"}, "compare: which recordings?"},
      {{"report", "walk.c3d"}, "report: which recording and which motion?"},
      {{"compare", "a.c3d", "--hide", "2"},
       "--hide: \"2\" is not allowed; give a number from 0 to 1"},
      {{"compare", "a.c3d", "--hide-model", "x"},
       "--hide-model: \"x\" is not allowed; use paper or stationary"},
      {{"compare", "a.c3d", "--repeat", "0"},
       "--repeat: \"0\" is not allowed; give a whole number from 1 to"},
      {{"compare", "a", "b", "c", "--height", "1.7", "--height", "1.8"},
       "--height is given 2 times for 3 files; give it once for all, or once for each"},
      {{"convert", "a.c3d", "b.c3d", "-o", "c.xml"},
       "--output is of one recording, but there are 2"},
      {{"convert", "a.c3d", "--inputMotion", "b.c3d"}, "one input only"},
      {{"convert", "a.c3d", "--height", "tall"},
       "--height: \"tall\" is not allowed; give metres from 0.5 to 2.5"},
      {{"convert", "a.c3d", "--height", "nan"}, "--height: \"nan\" is not allowed"},
      {{"convert", "a.c3d", "--height"}, "--height"},
      {{"convert", "a.c3d", "-o", "a", "--outputMotion", "b"}, "is given twice"},
      {{"convert", "a.c3d", "--frames", "1-5"}, "--frames: \"1-5\" is not allowed; use A:B"},
      {{"convert", "a.c3d", "--frames", "-5:9"}, "--frames: \"-5:9\" is not allowed; use A:B"},
      {{"convert", "a.c3d", "--format", "3"}, "\"3\" is not allowed; use 2.0 or 1.0"},
      {{"convert", "a.c3d", "--log", "loud"}, "\"loud\" is not a level; use off, error"},
      {{"export-urdf", "--height", "1.7"}, "export-urdf: which file is to be written?"},
      {{"help", "covnert"}, "help: unknown command \"covnert\" (did you mean convert?)"},
      {{"help", "--list", "colours"}, "--list: \"colours\" is not allowed; use commands,"},
      {{"info"}, "info: which file?"},
      {{"learn-markers"}, "learn-markers: which recordings?"},
      {{"learn-markers", "a.c3d"}, "learn-markers: where shall the marker set go?"},
      {{"print-config"}, "print-config: which converter?"}};
  for (const Misuse& misuse : misuses) {
    const auto run = RunProgram(misuse.arguments);
    SCOPED_TRACE(misuse.message);
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_EQ(run.out, "");
    EXPECT_THAT(run.err, AllOf(StartsWith("error: "), HasSubstr(misuse.message)));
  }
}

TEST(PrintConfig, PrintsTheTemplateOfAPlugin) {
  const std::string folder =
      std::filesystem::path(testing::TestPlugin("test_converter")).parent_path();
  const auto run =
      RunProgram({"print-config", "TestConverter"}, {{"MMM_CONVERTER_PLUGIN_PATH", folder}});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_EQ(run.err, "");
  EXPECT_THAT(run.out,
              AllOf(StartsWith("<?xml"), HasSubstr("<ConverterConfig type=\"TestConverter\">"),
                    HasSubstr("<MarkerMapping"), HasSubstr("heightOffset_mm=\"0\"")));
  EXPECT_EQ(RunProgram({"print-config", "--plugin", testing::TestPlugin("test_converter")}).out,
            run.out);
}

TEST(PrintConfig, TheShippedDefaultIsItsText) {
  const std::vector<std::pair<std::string, std::string>> shipped = {
      {"S2KFConverter", "xml_config/converters/s2kf_default.xml"},
      {"JacobianConverter", "xml_config/converters/jacobian_least_squares.xml"}};
  for (const auto& [converter, file] : shipped) {
    EXPECT_EQ(RunProgram({"print-config", converter}).out,
              testing::ReadText(testing::SourcePath(file)))
        << "print-config " << converter << " > " << file << " makes them equal";
  }
}

TEST(PrintConfig, SaysWhichConvertersThereAre) {
  const auto run = RunProgram({"print-config", "S2KF"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, AllOf(HasSubstr("there is no converter \"S2KF\""),
                             HasSubstr("found JacobianConverter and S2KFConverter"),
                             HasSubstr("looked in")));
}

TEST(PrintConfig, RefusesAPluginOfAnotherVersion) {
  const auto run = RunProgram({"print-config", "--plugin", testing::TestPlugin("old_version")});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("was built against interface version \"MMMConverterS2KF-0\""));
}

}  // namespace
}  // namespace mmm_converter
