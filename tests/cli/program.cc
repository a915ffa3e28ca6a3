// SPDX-License-Identifier: MIT
#include "tests/cli/program.h"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "tests/support/shared_data.h"
#include "tests/support/test_plugins.h"

namespace mmm_converter::testing {
namespace {

std::string Quoted(const std::string& word) {
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

std::string TestName() {
  const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
  std::string name = std::string(test->test_suite_name()) + "." + test->name();
  for (char& c : name) c = c == '/' ? '_' : c;
  return name;
}

}  // namespace

ProgramRun RunProgram(const std::vector<std::string>& arguments,
                      const std::map<std::string, std::string>& environment) {
  const std::string base = ::testing::TempDir() + "/cli_" + TestName();
  std::string command = "env";
  for (const auto& [name, value] : environment)
    command.append(" ").append(Quoted(name)).append("=").append(Quoted(value));
  command += " " + Quoted(MMM_CONVERTER_BINARY_DIR "/bin/MMMConverterS2KF");
  for (const std::string& argument : arguments) command += " " + Quoted(argument);
  command += " >" + Quoted(base + ".out") + " 2>" + Quoted(base + ".err") + " </dev/null";
  const int status = std::system(command.c_str());
  ProgramRun run;
  if (WIFEXITED(status)) run.exit_code = WEXITSTATUS(status);
  run.out = ReadText(base + ".out");
  run.err = ReadText(base + ".err");
  return run;
}

std::string TestFolder() {
  static std::string made_for;
  std::string folder = ::testing::TempDir() + "/cli_" + TestName();
  if (made_for != folder) {
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    made_for = folder;
  }
  return folder;
}

std::string ReadText(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

void WriteText(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

std::string Handstand() { return SourcePath("examples/handstand.c3d"); }

std::vector<std::string> WithTestConverter(std::vector<std::string> arguments) {
  arguments.insert(arguments.end(), {"--plugin", TestPlugin("test_converter")});
  return arguments;
}

}  // namespace mmm_converter::testing
