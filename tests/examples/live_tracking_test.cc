// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

#include "common/io/bytes/file_content.h"
#include "common/io/c3d/c3d_writer.h"
#include "common/io/recording/recording.h"
#include "tests/support/shared_data.h"
#include "tests/support/test_folder.h"

namespace mmm_converter {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class LiveTrackingTest : public ::testing::Test {
 protected:
  // What the example prints of a recording, errors too.
  std::string Track(const MarkerSequence& markers) {
    WriteC3d(folder_ + "/stream.c3d", markers);
    const std::string output = folder_ + "/output.txt";
    const int status = std::system(("\"" LIVE_TRACKING "\" \"replay:" + folder_ +
                                    "/stream.c3d@max\" 1.8 >\"" + output + "\" 2>&1")
                                       .c_str());
    code_ = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    return ReadFileContent(output);
  }

  const std::string folder_ = testing::TestFolder();
  const MarkerSequence sample_ =
      ReadRecording(testing::SourcePath("examples/handstand.c3d"), {}).markers;
  int code_ = -1;
};

// The first line of a posture, without the computing time that it ends with.
std::string FirstPosture(const std::string& text) {
  const std::size_t begin = text.find("root at");
  return text.substr(begin, text.find("seen", begin) - begin);
}

// LIFD and LIFP may stand for the same marker. Which of them does is decided before the stream
// starts, whether LIFD is seen later or never.
TEST_F(LiveTrackingTest, DoesNotKnowTheFuture) {
  constexpr int kFrames = 70;
  std::vector<std::string> labels = sample_.labels();
  labels.emplace_back("LIFP");
  MarkerSequence never(labels, kFrames, sample_.rate(), 0);
  const int lifd = never.FindLabel("LIFD");
  ASSERT_GE(lifd, 0);
  for (int k = 0; k < kFrames; ++k) {
    never.frame(k).leftCols(sample_.num_labels()) = sample_.frame(k);
    never.frame(k).rightCols(1) = sample_.frame(k).col(lifd);
    never.frame(k).col(lifd).setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  MarkerSequence later = never;
  later.frame(kFrames - 1).col(lifd) = sample_.frame(kFrames - 1).col(lifd);
  const std::string posture = FirstPosture(Track(never));
  EXPECT_EQ(code_, 0);
  EXPECT_THAT(posture, HasSubstr("52 markers"));
  EXPECT_EQ(FirstPosture(Track(later)), posture);
}

TEST_F(LiveTrackingTest, WaitsForAFrameWithEnoughMarkers) {
  MarkerSequence late = sample_.Slice(0, 120);
  for (int k = 0; k < 60; ++k) {
    late.frame(k)
        .rightCols(late.num_labels() - 2)
        .setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  const std::string said = Track(late);
  EXPECT_THAT(said, HasSubstr("frame 100: root at"));
  EXPECT_THAT(said, Not(HasSubstr("frame 50:")));
  EXPECT_EQ(code_, 0);
}

TEST_F(LiveTrackingTest, OfNobodyThereIsNoPosture) {
  MarkerSequence two = sample_.Slice(0, 60);
  for (int k = 0; k < 60; ++k) {
    two.frame(k)
        .rightCols(two.num_labels() - 2)
        .setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  const std::string said = Track(two);
  EXPECT_THAT(said, HasSubstr("53 of 53 labels are tracked"));
  EXPECT_THAT(said, Not(HasSubstr("root at")));
  EXPECT_EQ(code_, 0);
}

}  // namespace
}  // namespace mmm_converter
