// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace mmm_converter {

/// A sub-command. Results go to stdout, everything else to stderr. Returns the exit code.
struct Command {
  const char* name;
  const char* summary;  ///< one line
  int (*run)(const std::vector<std::string>& words);
};

int RunBatch(const std::vector<std::string>& words);
int RunCalibrate(const std::vector<std::string>& words);
int RunCheckDynamics(const std::vector<std::string>& words);
int RunCompare(const std::vector<std::string>& words);
int RunConvert(const std::vector<std::string>& words);
int RunEvaluate(const std::vector<std::string>& words);
int RunExportPoses(const std::vector<std::string>& words);
int RunExportUrdf(const std::vector<std::string>& words);
int RunInfo(const std::vector<std::string>& words);
int RunLabel(const std::vector<std::string>& words);
int RunLearnMarkers(const std::vector<std::string>& words);
int RunLive(const std::vector<std::string>& words);
int RunPrintConfig(const std::vector<std::string>& words);
int RunReport(const std::vector<std::string>& words);
int RunServe(const std::vector<std::string>& words);

}  // namespace mmm_converter
