// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>
#include <vector>

#include "tests/support/test_folder.h"

namespace mmm_converter::testing {

struct ProgramRun {
  int exit_code = -1;  ///< -1: did not end by itself
  std::string out;
  std::string err;
};

/// Runs the real MMMConverterS2KF, its output going to files (no terminal). environment: added.
ProgramRun RunProgram(const std::vector<std::string>& arguments,
                      const std::map<std::string, std::string>& environment = {});

/// The real program while it works; killed at the end of its scope.
class StartedProgram {
 public:
  explicit StartedProgram(const std::vector<std::string>& arguments);
  ~StartedProgram();
  StartedProgram(const StartedProgram&) = delete;
  StartedProgram& operator=(const StartedProgram&) = delete;

  /// Waits until a file has so many lines, or the program has ended.
  void WaitForLines(const std::string& file, int lines);
  /// Waits until it has said this, or has ended.
  void WaitForText(const std::string& text);
  void Send(int signal);
  /// Waits for its end. The exit code; of one that a signal killed, -signal.
  int Wait();
  /// What it has printed so far, warnings and errors too.
  std::string Said() const;

 private:
  bool HasEnded();

  TemporaryFolder said_;
  int process_ = -1;
  int status_ = 0;
  bool has_ended_ = false;
};

std::string ReadText(const std::string& path);
void WriteText(const std::string& path, const std::string& text);

/// The shipped sample recording.
std::string Handstand();

/// Options that convert with the TestConverter, which is quick.
std::vector<std::string> WithTestConverter(std::vector<std::string> arguments);

}  // namespace mmm_converter::testing
