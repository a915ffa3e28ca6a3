// SPDX-License-Identifier: MIT
#include "tests/cli/program.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <thread>

#include "tests/support/shared_data.h"
#include "tests/support/test_plugins.h"

namespace mmm_converter::testing {
namespace {

std::string Quoted(const std::string& word) {
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

}  // namespace

ProgramRun RunProgram(const std::vector<std::string>& arguments,
                      const std::map<std::string, std::string>& environment) {
  const TemporaryFolder said;
  std::string command = "env";
  for (const auto& [name, value] : environment)
    command.append(" ").append(Quoted(name)).append("=").append(Quoted(value));
  command += " " + Quoted(MMM_CONVERTER_BINARY_DIR "/bin/MMMConverterS2KF");
  for (const std::string& argument : arguments) command += " " + Quoted(argument);
  command +=
      " >" + Quoted(said.path() + "/out") + " 2>" + Quoted(said.path() + "/err") + " </dev/null";
  const int status = std::system(command.c_str());
  ProgramRun run;
  if (WIFEXITED(status)) run.exit_code = WEXITSTATUS(status);
  run.out = ReadText(said.path() + "/out");
  run.err = ReadText(said.path() + "/err");
  return run;
}

StartedProgram::StartedProgram(const std::vector<std::string>& arguments) {
  std::vector<std::string> words = {MMM_CONVERTER_BINARY_DIR "/bin/MMMConverterS2KF"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  pointers.reserve(words.size() + 1);
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  const std::string log = said_.path() + "/all";
  process_ = ::fork();
  if (process_ != 0) return;
  const int file = ::open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
  ::dup2(file, STDOUT_FILENO);
  ::dup2(file, STDERR_FILENO);
  ::execv(pointers.front(), pointers.data());
  ::_exit(127);
}

StartedProgram::~StartedProgram() {
  Send(SIGKILL);
  Wait();
}

bool StartedProgram::HasEnded() {
  has_ended_ = has_ended_ || ::waitpid(process_, &status_, WNOHANG) == process_;
  return has_ended_;
}

void StartedProgram::WaitForLines(const std::string& file, int lines) {
  const auto count = [&] {
    const std::string text = ReadText(file);
    return std::count(text.begin(), text.end(), '\n');
  };
  while (!HasEnded() && count() < lines) std::this_thread::yield();
}

void StartedProgram::WaitForText(const std::string& text) {
  while (!HasEnded() && Said().find(text) == std::string::npos) std::this_thread::yield();
}

void StartedProgram::Send(int signal) {
  if (!HasEnded()) ::kill(process_, signal);
}

int StartedProgram::Wait() {
  if (!has_ended_) ::waitpid(process_, &status_, 0);
  has_ended_ = true;
  return WIFSIGNALED(status_) ? -WTERMSIG(status_) : WEXITSTATUS(status_);
}

std::string StartedProgram::Said() const { return ReadText(said_.path() + "/all"); }

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
