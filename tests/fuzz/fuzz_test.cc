// SPDX-License-Identifier: MIT
#include "tests/fuzz/fuzz_target.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "common/io/bytes/file_content.h"
#include "tests/support/shared_data.h"

namespace mmm_converter {
namespace {

/// Files of the corpus are called TARGET-read-WHAT or TARGET-refused-WHAT.
std::vector<std::string> CorpusNames() {
  std::vector<std::string> names;
  for (const auto& file :
       std::filesystem::directory_iterator(testing::SourcePath("tests/fuzz/corpus"))) {
    names.push_back(file.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

TEST(FuzzCorpus, HasOfEachTargetWhatIsReadAndWhatIsRefused) {
  const std::vector<std::string> names = CorpusNames();
  for (const auto& [target, unused] : testing::FuzzTargets()) {
    for (const char* outcome : {"-read-", "-refused-"}) {
      EXPECT_TRUE(std::any_of(names.begin(), names.end(),
                              [&, beginning = target + outcome](const std::string& name) {
                                return name.starts_with(beginning);
                              }))
          << target << outcome;
    }
  }
}

class FuzzReplay : public ::testing::TestWithParam<std::string> {};

TEST_P(FuzzReplay, IsReadOrRefusedAsItsNameSays) {
  const std::string& name = GetParam();
  const std::string target = name.substr(0, name.find('-'));
  ASSERT_EQ(testing::FuzzTargets().count(target), 1U) << name;
  const std::string bytes = ReadFileContent(testing::SourcePath("tests/fuzz/corpus/" + name));
  const std::string refusal = testing::Refusal(testing::FuzzTargets().at(target), bytes);
  EXPECT_EQ(refusal.empty(), name.starts_with(target + "-read-")) << refusal;
}

INSTANTIATE_TEST_SUITE_P(Corpus, FuzzReplay, ::testing::ValuesIn(CorpusNames()),
                         [](const auto& instance) {
                           std::string name = instance.param;
                           std::replace_if(
                               name.begin(), name.end(),
                               [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
                           return name;
                         });

}  // namespace
}  // namespace mmm_converter
