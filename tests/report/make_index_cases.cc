// SPDX-License-Identifier: MIT
// make_index_cases FOLDER: indices of batches, and results.jsonl of the first, for the browser.
#include <exception>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "MMMConverterS2KF/report/batch_index.h"
#include "common/support/atomic_file.h"
#include "tests/report/comparison_cases.h"
#include "tests/report/result_cases.h"

namespace {

void MakeIndices(const std::string& folder) {
  namespace testing = mmm_converter::testing;
  using mmm_converter::Json;
  const auto write = [&](const std::string& name, const std::string& title,
                         const std::vector<Json>& results) {
    mmm_converter::WriteFileAtomically(folder + "/" + name + ".html",
                                       mmm_converter::FormatBatchIndex(title, results));
  };
  const std::vector<Json> results = testing::ManyResults(600);
  std::string lines;
  for (const Json& result : results) lines += mmm_converter::FormatJsonLine(result) + "\n";
  mmm_converter::WriteFileAtomically(folder + "/results.jsonl", lines);
  write("index", "kit", results);
  std::vector<Json> judged = testing::ManyResults(60);
  for (std::size_t i = 0; i < judged.size(); ++i) {
    if (judged[i]["state"] != "converted") continue;
    const char* levels[] = {"good", "check", "failed"};
    judged[i]["verdict"] = {{"level", levels[i % 3]}, {"reasons", Json::array()}};
  }
  write("levels", "levels", judged);
  write("hostile", testing::kHostileText, testing::HostileResults());
  write("empty", "nothing", {});
  write("failed", "all failed", testing::FailedResults(30));
  write("one", "one", testing::ManyResults(1));
  write("large", "large", testing::ManyResults(100'000));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "use: make_index_cases FOLDER\n";
    return 2;
  }
  try {
    MakeIndices(argv[1]);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
  return 0;
}
