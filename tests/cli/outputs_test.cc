// SPDX-License-Identifier: MIT
// No command overwrites what it reads, or one output with another, or starts work whose output
// can't be written.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/cli/program.h"
#include "tests/common/retarget/biped.h"
#include "tests/support/test_folder.h"

namespace mmm_converter::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

// A call that would lose a file: words with {R} for a recording, {M} for a motion of it, {S} for a
// subject.
struct Call {
  std::string words;
  std::string lost;  // "{R}"
};

std::string WithReplaced(std::string text, const std::string& mark, const std::string& value) {
  for (std::size_t at = text.find(mark); at != std::string::npos; at = text.find(mark)) {
    text.replace(at, mark.size(), value);
  }
  return text;
}

class Outputs : public ::testing::TestWithParam<Call> {
 protected:
  std::string In(const std::string& name) const { return TestFolder() + "/" + name; }
  std::string Filled(const std::string& text) const {
    std::string filled = WithReplaced(text, "{R}", In("walk.c3d"));
    filled = WithReplaced(filled, "{M}", In("walk_mmm.xml"));
    return WithReplaced(filled, "{NEW}", In("new"));
  }
  std::vector<std::string> Words(const std::string& text) const {
    std::vector<std::string> words;
    std::istringstream stream(text);
    for (std::string word; stream >> word;) words.push_back(Filled(word));
    return words;
  }
};

TEST_P(Outputs, NothingThatIsReadIsLost) {
  fs::copy_file(Handstand(), In("walk.c3d"));
  fs::copy_file(fs::path(Handstand()).parent_path() / "handstand_true.xml", In("walk_mmm.xml"));
  const std::string lost = Filled(GetParam().lost);
  const std::string before = ReadText(lost);
  const ProgramRun run = RunProgram(Words(GetParam().words));
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr(lost + ": is read, and would be lost"));
  EXPECT_EQ(ReadText(lost), before);
  EXPECT_FALSE(fs::exists(In("new")));
}

INSTANTIATE_TEST_SUITE_P(
    Commands, Outputs,
    ::testing::Values(
        Call{"compare {R} --height 1.8 -c s2kf_default --csv {NEW} --json {R}", "{R}"},
        Call{"compare {R} --height 1.8 -c s2kf_default --csv {R}", "{R}"},
        Call{"compare {R} --height 1.8 -c s2kf_default --gnuplot {R}", "{R}"},
        Call{"compare {R} --height 1.8 -c s2kf_default --report {R}", "{R}"},
        Call{"compare {R} --height 1.8 -c s2kf_default --truth {M} --report {M}", "{M}"},
        Call{"report {R} {M} --json {NEW} -o {M}", "{M}"},
        Call{"report {R} {M} -o {NEW} --csv {R}", "{R}"},
        Call{"calibrate {R} --height 1.8 -o {NEW} --summary {R}", "{R}"},
        Call{"calibrate {R} --height 1.8 -o {NEW} --report {R}", "{R}"},
        Call{"calibrate {R} --height 1.8 -o {NEW} --model-out {R}", "{R}"},
        Call{"calibrate {R} --height 1.8 -o {R}", "{R}"},
        Call{"check-dynamics {M} --summary {M}", "{M}"},
        Call{"check-dynamics {M} --summary {NEW} --report {M}", "{M}"},
        Call{"convert {R} --height 1.8 -o {NEW} --summary {R}", "{R}"},
        Call{"convert {R} --height 1.8 -o {NEW} --export-csv {R}", "{R}"},
        Call{"live replay:{R}@max --height 1.8 -o {R}", "{R}"},
        Call{"live replay:{R}@max --height 1.8 -o {NEW} --export-csv {R}", "{R}"},
        Call{"export-urdf --height 1.8 --mass 75 --model {M} -o {M}", "{M}"}));

TEST(TwoOutputs, AreNotOneFile) {
  const std::string file = TestFolder() + "/one";
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"calibrate", Handstand(), "--height", "1.8", "-o", file,
                                 "--model-out", file},
        std::vector<std::string>{"compare", Handstand(), "--height", "1.8", "--json", file, "--csv",
                                 file},
        std::vector<std::string>{"convert", Handstand(), "--height", "1.8", "-o", file, "--report",
                                 file}}) {
    const ProgramRun run = RunProgram(words);
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_THAT(run.err, HasSubstr(file + ": is to hold two outputs"));
    EXPECT_FALSE(fs::exists(file));
  }
}

TEST(OutputsThatCantBeWritten, AreNamedBeforeTheWork) {
  const std::string file = TestFolder() + "/absent/file";
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"calibrate", Handstand(), "--height", "1.8", "--summary", file},
        std::vector<std::string>{"compare", Handstand(), "--height", "1.8", "--json", file},
        std::vector<std::string>{"report", Handstand(), Handstand(), "-o", file},
        std::vector<std::string>{"evaluate", "-o", "/dev/null/folder"}}) {
    const ProgramRun run = RunProgram(words);
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_EQ(run.out, "");
  }
}

std::string LegText(const std::string& side, const std::string& y) {
  const auto joint = [&](const std::string& name, const std::string& axis, const char* range) {
    return "<joint name='" + side + "_" + name + "' axis='" + axis + "' range='" + range + "'/>";
  };
  const std::string inertial = "<inertial pos='0 0 -.2' mass='3' diaginertia='.1 .1 .1'/>";
  return "<body name='" + side + "_thigh' pos='0 " + y + " 0'>" +
         joint("hip_yaw", "0 0 1", "-1 1") + joint("hip_roll", "1 0 0", "-1 1") +
         joint("hip_pitch", "0 1 0", "-2 2") + inertial + "<body name='" + side +
         "_shin' pos='0 0 -.4'>" + joint("knee", "0 1 0", "0 2.5") + inertial + "<body name='" +
         side + "_foot' pos='0 0 -.4'>" + joint("ankle", "0 1 0", "-1 1") + inertial +
         "<geom type='box' size='0.1 0.05 0.02' pos='0.03 0 -0.03'/></body></body></body>";
}

std::string RobotWithPart() {
  return "<mujoco><compiler angle='radian'/><include file='part.xml'/><worldbody><body "
         "name='base' pos='0 0 1'><freejoint/>" +
         LegText("left", "0.1") + LegText("right", "-0.1") + "</body></worldbody></mujoco>";
}

// A run that reads `part` only because another input names it.
struct NamedPart {
  const char* words;
  const char* part;
};

class PartsThatInputsName : public ::testing::TestWithParam<NamedPart> {};

TEST_P(PartsThatInputsName, AreNoOutputs) {
  const auto in = [](const std::string& name) { return TestFolder() + "/" + name; };
  fs::copy_file(Handstand(), in("walk.c3d"));
  fs::copy_file(fs::path(Handstand()).parent_path() / "handstand_true.xml", in("walk.xml"));
  WriteText(in("part.xml"), "<mujoco/>");
  WriteText(in("robot.xml"), RobotWithPart());
  WriteText(in("data.mot"), "endheader\ntime\tf_vx\tf_vy\tf_vz\n0\t0\t0\t0\n0.5\t0\t0\t0\n");
  WriteText(in("loads.xml"),
            "<OpenSimDocument><ExternalLoads><objects><ExternalForce name='f'><force_identifier>f_v"
            "</force_identifier></ExternalForce></objects><datafile>data.mot</datafile>"
            "</ExternalLoads></OpenSimDocument>");
  std::vector<std::string> words;
  std::istringstream stream(GetParam().words);
  for (std::string word; stream >> word;) {
    words.push_back(word.find('.') == std::string::npos || word == "1.8" ? word : in(word));
  }
  const std::string part = in(GetParam().part);
  const std::string before = ReadText(part);
  const ProgramRun run = RunProgram(words);
  EXPECT_EQ(run.exit_code, 1) << run.err;
  EXPECT_THAT(run.err, HasSubstr(GetParam().part + std::string(": is read, and would be lost")));
  EXPECT_EQ(ReadText(part), before);
  EXPECT_FALSE(fs::exists(in("new.xml")));
}

INSTANTIATE_TEST_SUITE_P(
    Outputs, PartsThatInputsName,
    ::testing::Values(
        NamedPart{"retarget walk.xml --height 1.8 --robot robot.xml -o part.xml", "part.xml"},
        NamedPart{"retarget walk.xml --height 1.8 --robot robot.xml -o new.xml --summary part.xml",
                  "part.xml"},
        NamedPart{"convert walk.c3d --height 1.8 --forces loads.xml -o new.xml --export-contacts "
                  "data.mot",
                  "data.mot"},
        NamedPart{"convert walk.c3d --height 1.8 --forces loads.xml --export-contacts c.csv -o "
                  "new.xml --report data.mot",
                  "data.mot"}));

TEST(PartsOfARobot, AreNoOutputsOfLive) {
  WriteText(TestFolder() + "/part.xml", "<mujoco/>");
  WriteText(TestFolder() + "/robot.xml", RobotWithPart());
  const ProgramRun run =
      RunProgram({"live", "replay:" + Handstand() + "@max", "--height", "1.8", "--robot",
                  TestFolder() + "/robot.xml", "-o", TestFolder() + "/part.xml"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("part.xml: is read, and would be lost"));
  EXPECT_EQ(ReadText(TestFolder() + "/part.xml"), "<mujoco/>");
}

TEST(OutputsBesideOthers, ReplaceNothingOfSomebodyElse) {
  WriteText(TestFolder() + "/names.names.json", "mine");
  WriteText(TestFolder() + "/biped.urdf", BipedText({}));
  const ProgramRun run = RunProgram({"retarget", Handstand(), "--height", "1.8", "--robot",
                                     TestFolder() + "/biped.urdf", "-o", TestFolder() + "/new.xml",
                                     "--export-phc", TestFolder() + "/names"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("names.names.json: is there, was not written by this program"));
  EXPECT_EQ(ReadText(TestFolder() + "/names.names.json"), "mine");
}

TEST(OutputsWithoutAName, AreAMisuse) {
  const ProgramRun run = RunProgram(
      {"convert", Handstand(), "--height", "1.8", "-o", TestFolder() + "/new.xml", "--report", ""});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("--report names nothing"));
  EXPECT_FALSE(fs::exists(TestFolder() + "/new.xml"));
}

}  // namespace
}  // namespace mmm_converter::testing
