// SPDX-License-Identifier: MIT
#include "common/io/recording/marker_labels.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>

#include "common/support/error.h"

namespace mmm_converter {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;

// A subject for each label, declared as such: quadratic, were they searched one after the other.
TEST(MarkerLabels, ManySubjectsTakeLittleTime) {
  constexpr int kLabels = 60000;
  std::vector<std::string> labels;
  std::vector<std::string> prefixes;
  for (int i = 0; i < kLabels; ++i) {
    prefixes.push_back("s" + std::to_string(i));
    labels.push_back(prefixes.back() + "_LKNE");
  }
  const auto start = std::chrono::steady_clock::now();
  try {
    SelectLabels(labels, {}, prefixes, "", "a.c3d", nullptr);
    FAIL();
  } catch (const Error& error) {
    EXPECT_LT(std::string_view(error.what()).size(), 300U) << error.what();
  }
  // 0.1 s where it is linear, a minute where it is not.
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
}

TEST(MarkerLabels, AreNumberedWhereTheyBecomeTheSame) {
  const std::vector<std::string> labels = {"Kn\xC3\xB6", "Kn\xF6", "a\x01z", "a z",
                                           "a z#2",      "s:C7",   "s_C7"};
  Warnings warnings;
  const LabelSelection persons =
      SelectLabels({labels.begin() + 5, labels.end()}, {}, {}, "", "a.c3d", &warnings);
  EXPECT_THAT(persons.labels, ElementsAre("C7", "C7#2"));
  const LabelSelection others =
      SelectLabels({labels.begin(), labels.begin() + 5}, {}, {}, "", "a.c3d", &warnings);
  EXPECT_THAT(others.labels, ElementsAre("Kn\xC3\xB6", "Kn\xC3\xB6#2", "a z", "a z#3", "a z#2"));
  EXPECT_THAT(warnings.texts(),
              Contains("labels that are the same as others, without prefixes and in UTF-8, are "
                       "numbered: Kn\xC3\xB6#2, a z#3"));
}

}  // namespace
}  // namespace mmm_converter
