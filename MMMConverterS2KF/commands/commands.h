// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace mmm_converter {

/// A sub-command. Results go to stdout, everything else to stderr.
struct Command {
  const char* name;
  const char* summary;  ///< one line
  void (*run)(const std::vector<std::string>& words);
};

void RunConvert(const std::vector<std::string>& words);
void RunInfo(const std::vector<std::string>& words);
void RunPrintConfig(const std::vector<std::string>& words);

}  // namespace mmm_converter
