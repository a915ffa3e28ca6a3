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
    SelectLabels(labels, {}, prefixes, {}, "a.c3d", nullptr);
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
      SelectLabels({labels.begin() + 5, labels.end()}, {}, {}, {}, "a.c3d", &warnings);
  EXPECT_THAT(persons.labels, ElementsAre("C7", "C7#2"));
  const LabelSelection others =
      SelectLabels({labels.begin(), labels.begin() + 5}, {}, {}, {}, "a.c3d", &warnings);
  EXPECT_THAT(others.labels, ElementsAre("Kn\xC3\xB6", "Kn\xC3\xB6#2", "a z", "a z#3", "a z#2"));
  EXPECT_THAT(warnings.texts(),
              Contains("labels that are the same as others, without prefixes and in UTF-8, are "
                       "numbered: Kn\xC3\xB6#2, a z#3"));
}

std::vector<std::string> With(const std::string& prefix, const std::vector<std::string>& labels) {
  std::vector<std::string> all = labels;
  for (std::string& label : all) label.insert(0, prefix + ":");
  return all;
}

const std::vector<std::string> kLegs = {"LASI", "RASI", "LKNE", "RKNE", "LANK",
                                        "RANK", "LTOE", "RTOE", "LHEE"};
const std::vector<std::string> kTrunk = {"C7", "CLAV", "LSHO", "RSHO"};

TEST(MarkerLabels, PartsOfOneBodyAreOnePerson) {
  std::vector<std::string> labels = With("Legs", kLegs);
  for (const std::string& label : With("Trunk", kTrunk)) labels.push_back(label);
  for (const std::string& label : With("Box", {"b1", "b2", "b3", "b4"})) labels.push_back(label);
  Warnings warnings;
  const LabelSelection both = SelectLabels(labels, {}, {}, {}, "a.c3d", &warnings);
  EXPECT_EQ(both.labels.size(), kLegs.size() + kTrunk.size());
  EXPECT_THAT(both.labels, Contains("LSHO"));
  EXPECT_EQ(both.subject, "");
  EXPECT_THAT(both.subjects, ElementsAre("Legs", "Trunk", "Box"));
  EXPECT_THAT(warnings.texts(), ElementsAre("markers of Legs, Trunk are parts of one body: read as "
                                            "one person",
                                            "markers left out: those of Box"));
  EXPECT_EQ(SelectLabels(labels, {}, {}, "Legs", "a.c3d", nullptr).labels, kLegs);
}

TEST(MarkerLabels, SeveralPrefixesMayBeAskedForAsOnePerson) {
  std::vector<std::string> labels = With("A", kLegs);
  for (const std::string& label : With("B", kLegs)) labels.push_back(label);
  for (const std::string& label : With("C", kTrunk)) labels.push_back(label);
  for (const std::string& label : With("D", kTrunk)) labels.push_back(label);
  const LabelSelection chosen = SelectLabels(labels, {}, {}, " b:, D", "a.c3d", nullptr);
  EXPECT_EQ(chosen.labels.size(), kLegs.size() + kTrunk.size());
  EXPECT_EQ(chosen.indices.front(), 9);
  EXPECT_EQ(chosen.indices.back(), 25);
  const auto message = [&](const std::optional<std::string>& subject) {
    try {
      SelectLabels(labels, {}, {}, subject, "a.c3d", nullptr);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_EQ(message("B,E"), "a.c3d: there is no subject E; the file has: A, B, C, D");
  EXPECT_EQ(message(std::nullopt), "a.c3d: there are several subjects: A, B; choose one of them");
  EXPECT_EQ(message(""), "a.c3d: there is no subject without prefix; the file has: A, B, C, D");
}

// Cortex writes columns of computed markers, V_LASI beside LASI, that may never hold a value.
TEST(MarkerLabels, WhoIsNeverSeenIsNoSubject) {
  std::vector<std::string> labels = kLegs;
  for (const std::string& label : kLegs) labels.push_back("W_" + label);
  std::vector<bool> seen(labels.size(), true);
  const auto are_seen = [&] { return seen; };
  const auto select = [&](const std::optional<std::string>& subject) {
    return SelectLabels(labels, {}, {}, subject, "a.trc", nullptr, false, are_seen).labels;
  };
  EXPECT_THROW(select(std::nullopt), Error);
  EXPECT_EQ(select(""), kLegs);
  std::fill(seen.begin() + static_cast<std::ptrdiff_t>(kLegs.size()), seen.end(), false);
  EXPECT_EQ(select(std::nullopt), kLegs);
  std::replace_if(
      labels.begin(), labels.end(), [](const std::string& l) { return l.starts_with("W_"); }, "");
  std::fill(seen.begin(), seen.end(), true);
  for (std::size_t i = 0; i < kLegs.size(); ++i) labels[kLegs.size() + i] = "V_" + kLegs[i];
  EXPECT_EQ(select(std::nullopt), kLegs);
}

// Who wears the same markers as another is another person.
TEST(MarkerLabels, ASecondPersonIsNoPart) {
  std::vector<std::string> labels = With("A", kLegs);
  for (const std::string& label : With("B", {"LKNE", "LANK", "LTOE"})) labels.push_back(label);
  Warnings warnings;
  EXPECT_EQ(SelectLabels(labels, {}, {}, {}, "a.c3d", &warnings).labels, kLegs);
  EXPECT_THAT(warnings.texts(), ElementsAre("markers left out: those of B"));
}

}  // namespace
}  // namespace mmm_converter
