// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string_view>

#include "tests/cli/program.h"

namespace mmm_converter {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::IsSupersetOf;
using ::testing::Not;
using testing::ReadText;
using testing::RunProgram;
using testing::TestFolder;
using testing::WriteText;

std::vector<std::string> Lines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::vector<std::string> CommandNames() {
  return Lines(RunProgram({"help", "--list", "commands"}).out);
}

// Long names of the options that the help of a command describes: "  --name ..." or
// "  -n [ --name ] ...".
std::vector<std::string> OptionsOf(const std::string& command) {
  constexpr std::size_t kShort = std::string_view("-n [ ").size();
  std::vector<std::string> options;
  for (const std::string& line : Lines(RunProgram({command, "--help"}).out)) {
    if (!line.starts_with("  -")) continue;
    const std::size_t begin = line.starts_with("  --") ? 2 : 2 + kShort;
    const std::size_t end = line.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-", begin);
    options.push_back(line.substr(begin, end - begin));
  }
  return options;
}

std::string WithRoffDashes(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '-') escaped += '\\';
    escaped += c;
  }
  return escaped;
}

TEST(Manual, HasAPageForEveryCommandWithEveryOption) {
  ASSERT_THAT(CommandNames(), IsSupersetOf({"convert", "help", "serve"}));
  for (const std::string& command : CommandNames()) {
    SCOPED_TRACE(command);
    const std::string page = RunProgram({"help", command, "--man"}).out;
    EXPECT_THAT(page,
                AllOf(HasSubstr(".SH SYNOPSIS\n\\fBMMMConverterS2KF " + WithRoffDashes(command)),
                      HasSubstr(".SH EXAMPLES\n"), Not(HasSubstr("{}"))));
    const auto options = OptionsOf(command);
    EXPECT_THAT(options, Contains("--help"));
    for (const std::string& option : options) {
      EXPECT_THAT(page, HasSubstr("\\fB" + WithRoffDashes(option) + "\\fR"));
    }
  }
}

TEST(Manual, PageOfTheProgramNamesItsCommands) {
  const std::string page = RunProgram({"help", "--man"}).out;
  for (const std::string& command : CommandNames()) {
    EXPECT_THAT(page, HasSubstr(".TP\n\\fB" + WithRoffDashes(command) + "\\fR\n"));
    EXPECT_THAT(page, HasSubstr("\\fBMMMConverterS2KF\\-" + WithRoffDashes(command) + "\\fR(1)"));
  }
  EXPECT_THAT(page, AllOf(HasSubstr(".SH ENVIRONMENT\n"), HasSubstr(".SH EXIT CODES\n")));
}

TEST(Manual, MMMMotionConvertersNamesAreThere) {
  EXPECT_THAT(RunProgram({"help", "convert", "--man"}).out,
              HasSubstr("; also \\fB\\-\\-outputMotion\\fR\n"));
}

TEST(Manual, GroffHasNothingToSayOfAnyPage) {
  if (std::system("groff -v > /dev/null 2>&1") != 0) GTEST_SKIP() << "no groff";
  std::vector<std::string> commands = CommandNames();
  commands.emplace_back("");  // the program
  const std::string page = TestFolder() + "/page";
  const std::string said = TestFolder() + "/said";
  for (const std::string& command : commands) {
    SCOPED_TRACE(command);
    std::vector<std::string> arguments = {"help", "--man"};
    if (!command.empty()) arguments.push_back(command);
    WriteText(page, RunProgram(arguments).out);
    const std::string groff =
        fmt::format("groff -k -man -ww -Tutf8 -P-cbu '{0}' > '{0}.txt' 2> '{1}'", page, said);
    EXPECT_EQ(std::system(groff.c_str()), 0);
    EXPECT_EQ(ReadText(said), "");
    EXPECT_THAT(ReadText(page + ".txt"), HasSubstr("NAME\n"));
  }
}

class Completion : public ::testing::Test {
 protected:
  void SetUp() override {
    if (std::system("bash --version > /dev/null 2>&1") != 0) GTEST_SKIP() << "no bash";
    WriteText(TestFolder() + "/completion", RunProgram({"help", "--completion"}).out);
    std::filesystem::create_directory(TestFolder() + "/home");
  }

  // What bash offers for the last of the words, in the folder home.
  static std::vector<std::string> Complete(const std::vector<std::string>& words) {
    const std::string& folder = TestFolder();
    std::string line = "'" MMM_CONVERTER_BINARY_DIR "/bin/MMMConverterS2KF'";
    for (const std::string& word : words) line += " '" + word + "'";
    WriteText(folder + "/script",
              fmt::format("set -u\nsource '{0}/completion'\ncd '{0}/home'\nCOMP_WORDS=({1})\n"
                          "COMP_CWORD={2}\n_MMMConverterS2KF \"${{COMP_WORDS[0]}}\"\n"
                          "((${{#COMPREPLY[@]}} == 0)) || printf '%s\\n' \"${{COMPREPLY[@]}}\"\n",
                          folder, line, words.size()));
    const std::string command =
        "bash --norc '" + folder + "/script' > '" + folder + "/offered' 2> '" + folder + "/said'";
    EXPECT_EQ(std::system(command.c_str()), 0);
    EXPECT_EQ(ReadText(folder + "/said"), "");
    return Lines(ReadText(folder + "/offered"));
  }
};

TEST_F(Completion, OffersEveryCommandAndEveryOption) {
  std::vector<std::string> commands = CommandNames();
  commands.insert(commands.end(), {"--help", "--version"});
  EXPECT_EQ(Complete({""}), commands);
  EXPECT_THAT(Complete({"conv"}), ElementsAre("convert"));
  for (const std::string& command : CommandNames()) {
    EXPECT_EQ(Complete({command, "-"}), OptionsOf(command));
  }
  EXPECT_THAT(Complete({"convert", "walk.c3d", "--export-mot"}), ElementsAre("--export-mot"));
  EXPECT_THAT(Complete({"fly", "-"}), IsEmpty());
}

TEST_F(Completion, OffersFilesWithSpacesAndFolders) {
  WriteText(TestFolder() + "/home/a walk.c3d", "");
  std::filesystem::create_directory(TestFolder() + "/home/a folder");
  EXPECT_THAT(Complete({"convert", "a w"}), ElementsAre("a walk.c3d"));
  EXPECT_THAT(Complete({"convert", "-o", "a "}),
              ::testing::UnorderedElementsAre("a folder", "a walk.c3d"));
  EXPECT_THAT(Complete({"convert", "--outputMotion", "a w"}), ElementsAre("a walk.c3d"));
  EXPECT_THAT(Complete({"batch", "--scan", ""}), ElementsAre("a folder"));
  EXPECT_THAT(Complete({"convert", "--height", ""}), IsEmpty());
}

TEST_F(Completion, OffersWhatIsInstalledAndWhatIsAllowed) {
  EXPECT_THAT(Complete({"convert", "-c", "s2kf"}),
              ElementsAre("s2kf_default", "s2kf_offline", "s2kf_paper"));
  EXPECT_THAT(Complete({"convert", "--config", "=", "uk"}), ElementsAre("ukf"));
  EXPECT_THAT(Complete({"label", "--marker-set", "="}), IsSupersetOf({"kit53", "plugin_gait"}));
  EXPECT_THAT(Complete({"live", "--converter", "S"}), ElementsAre("S2KFConverter"));
  EXPECT_THAT(Complete({"print-config", "ba"}), ElementsAre("batch", "batch-schema"));
  EXPECT_THAT(Complete({"help", "ser"}), ElementsAre("serve"));
  EXPECT_THAT(Complete({"serve", "--as", ""}), ElementsAre("qtm", "natnet"));
  EXPECT_THAT(Complete({"info", "--up", "-"}), ElementsAre("-x", "-y", "-z"));
  for (const std::string& level : Complete({"info", "--log", ""})) {
    EXPECT_EQ(RunProgram({"info", "/no/such/file", "--log", level}).exit_code, 1);  // not misused
  }
}

}  // namespace
}  // namespace mmm_converter
