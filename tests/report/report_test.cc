// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/report/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "MMMConverterS2KF/report/comparison_json.h"
#include "MMMConverterS2KF/report/drawn_frames.h"
#include "common/support/units.h"
#include "tests/report/comparison_cases.h"

namespace mmm_converter {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

int CountOf(const std::string& text, const std::string& part) {
  int count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++count;
  }
  return count;
}

// The first data block of a name, as a browser would see its text.
std::string Block(const std::string& page, const std::string& name) {
  const std::string start = "<script type=\"application/json\" class=\"" + name + "\">";
  const std::size_t begin = page.find(start) + start.size();
  return page.substr(begin, page.find("</script>", begin) - begin);
}

std::string HostilePage() {
  const Comparison comparison = testing::HostileComparison();
  return FormatReport(testing::kHostileText,
                      {{testing::kHostileText, testing::kHostileText, &comparison}});
}

TEST(Report, FiguresAreThoseOfTheJson) {
  const Comparison comparison = testing::HostileComparison();
  const std::string page = FormatReport("title", {{"title", "", &comparison}});
  EXPECT_EQ(nlohmann::json::parse(Block(page, "figures")), nlohmann::json(ToJson(comparison)));
}

TEST(Report, HostileTextEndsNoElement) {
  const std::string page = HostilePage();
  // Three libraries' and our scripts, three data blocks.
  EXPECT_EQ(CountOf(page, "<script"), 6);
  EXPECT_EQ(CountOf(page, "</script"), 6);
  EXPECT_EQ(CountOf(page, "<title>"), 1);
  EXPECT_THAT(page, Not(HasSubstr("<img")));
  EXPECT_THAT(page, HasSubstr("<title>&lt;/script&gt;&lt;script&gt;window.hacked=1"));
  EXPECT_EQ(nlohmann::json::parse(Block(page, "heading"))["text"], testing::kHostileText);
}

TEST(Report, BytesThatAreNoUtf8AreReplaced) {
  Comparison comparison = testing::HostileComparison();
  comparison.contenders[0].configuration = "\xff\xfe";
  comparison.trials[0].name = "\x80";
  const std::string page = FormatReport("t", {{"\xc3", "\xe2\x82", &comparison}});
  EXPECT_EQ(nlohmann::json::parse(Block(page, "heading"))["title"], "\xef\xbf\xbd");
  EXPECT_EQ(nlohmann::json::parse(Block(page, "tracks"))["trials"][0]["name"], "\xef\xbf\xbd");
}

TEST(Report, NothingIsLoadedFromElsewhere) {
  const std::string page = HostilePage();
  EXPECT_THAT(page, HasSubstr("default-src 'none'; script-src 'sha256-"));
  EXPECT_THAT(page, Not(HasSubstr("<link")));
  EXPECT_THAT(page, Not(HasSubstr("@import")));
  EXPECT_THAT(page, Not(HasSubstr("<script src")));
}

// Made once: it takes as long as all else here.
const Comparison& OneMinute() {
  static const Comparison comparison = testing::LongComparison();
  return comparison;
}

TEST(Report, ALongRecordingStaysSmall) {
  const Comparison& comparison = OneMinute();
  ASSERT_EQ(comparison.trials[0].markers.num_frames(), 6000);
  ASSERT_EQ(comparison.grounds[0].labels.size(), 53);
  ASSERT_EQ(comparison.rows[0].result.trajectory.joint_names.size(), 44);
  const std::string page = FormatReport("60 s", {{"60 s", "", &comparison}});
  std::cout << "[ measured ] 60 s at 100 Hz: " << static_cast<double>(page.size()) * 1e-6
            << " MB\n";
  EXPECT_LT(page.size(), 8'000'000);
}

TEST(Report, TenMinutesStaySmall) {
  const Comparison comparison = testing::Repeated(OneMinute(), 10);
  ASSERT_EQ(comparison.trials[0].markers.num_frames(), 60'000);
  const std::string page = FormatReport("10 min", {{"10 min", "", &comparison}});
  std::cout << "[ measured ] 10 min at 100 Hz: " << static_cast<double>(page.size()) * 1e-6
            << " MB\n";
  EXPECT_LT(page.size(), 10'000'000);
  const auto trial = nlohmann::json::parse(Block(page, "tracks"))["trials"][0];
  EXPECT_EQ(trial["frames"], 6000);
  EXPECT_EQ(trial["every"], 10);
}

TEST(DrawnFrames, AreAllOfAShortRecording) {
  const DrawnFrames drawn(6000);
  EXPECT_TRUE(drawn.are_all());
  EXPECT_EQ(drawn.count(), 6000);
  EXPECT_EQ(DrawnFrames(0).count(), 0);
}

TEST(DrawnFrames, KeepTheLeastAndMostOfWhatIsNotDrawn) {
  const DrawnFrames drawn(6002);  // blocks of two
  EXPECT_EQ(drawn.every(), 2);
  EXPECT_EQ(drawn.count(), 3001);
  EXPECT_EQ(drawn.frame(3000), 6000);
  Eigen::VectorXd frames = Eigen::VectorXd::Zero(6002);
  frames.head<6>() << 1, 5, kNaN, -2, kNaN, kNaN;
  EXPECT_EQ(drawn.Of(frames)(0), 1);
  EXPECT_EQ(drawn.MostOf(frames)(0), 5);
  EXPECT_EQ(drawn.LeastOf(frames)(0), 1);
  EXPECT_TRUE(std::isnan(drawn.Of(frames)(1)));
  EXPECT_EQ(drawn.LeastOf(frames)(1), -2);
  EXPECT_TRUE(std::isnan(drawn.MostOf(frames)(2)));
}

TEST(Report, MayBeEmpty) { EXPECT_THAT(FormatReport("nothing", {}), HasSubstr("nothing</h1>")); }

}  // namespace
}  // namespace mmm_converter
