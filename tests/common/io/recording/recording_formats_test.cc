// SPDX-License-Identifier: MIT
#include "common/io/recording/recording_formats.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "common/support/error.h"

namespace mmm_converter {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class RecordingFormatsTest : public ::testing::Test {
 protected:
  ~RecordingFormatsTest() override { std::filesystem::remove(path_); }

  std::string Write(const std::string& content) const {
    std::ofstream(path_, std::ios::binary) << content;
    return path_;
  }

  /// "" where the content is of no format.
  std::string NameOf(const std::string& content) const {
    const RecordingFormat* format = FindFormatOfContent(Write(content));
    return format == nullptr ? "" : format->name;
  }

 private:
  const std::string path_ = ::testing::TempDir() + "recording_formats_" +
                            ::testing::UnitTest::GetInstance()->current_test_info()->name();
};

TEST_F(RecordingFormatsTest, AreToldByNameInAnyCase) {
  EXPECT_STREQ(FindFormatOfName("a/walk.C3D")->name, "C3D");
  EXPECT_STREQ(FindFormatOfName("walk.trc")->name, "TRC");
  EXPECT_STREQ(FindFormatOfName("walk.xml")->name, "MMM motion");
  EXPECT_TRUE(FindFormatOfName("walk.csv")->is_told_by_content);
  EXPECT_FALSE(FindFormatOfName("walk.tsv")->is_written);
  EXPECT_EQ(FindFormatOfName("walk"), nullptr);
  EXPECT_EQ(RecordingFormatNames(),
            "C3D, TRC, Nexus CSV, Motive CSV, QTM TSV, CSV of points, BVH, "
            "AMASS, NPY of joints or MMM motion");
}

TEST_F(RecordingFormatsTest, AreToldByContentWhateverTheName) {
  EXPECT_EQ(NameOf("\x02P and so on"), "C3D");
  EXPECT_EQ(NameOf(std::string(512, '\0') + "\x02P"), "C3D");
  EXPECT_EQ(NameOf("PathFileType\t4\t(X/Y/Z)\twalk.trc\n"), "TRC");
  EXPECT_EQ(NameOf("PathFileType\t4\t(X/Y/Z)\twalk.trc\rDataRate\r"), "TRC");
  EXPECT_EQ(NameOf("Trajectories\n100\n,,A:C7,,\n"), "Nexus CSV");
  EXPECT_EQ(NameOf("Format Version,1.23,Take Name,a\n"), "Motive CSV");
  EXPECT_EQ(NameOf(" hierarchy\r\nROOT Hips"), "BVH");
  EXPECT_EQ(NameOf("NO_OF_FRAMES\t20\n"), "QTM TSV");
  EXPECT_EQ(NameOf("time,A_x,A_y,A_z,B_x,B_y,B_z,C_x,C_y,C_z\n"), "CSV of points");
  EXPECT_EQ(NameOf("time;A;A;A;B;B;B;C;C;C\n;x;y;z;x;y;z;x;y;z\n"), "CSV of points");
  EXPECT_EQ(NameOf("\xEF\xBB\xBF <?xml version='1.0'?><MMM/>"), "MMM motion");
  EXPECT_EQ(NameOf("<Robot>\nFrame#\tTime\n</Robot>"), "");
  EXPECT_EQ(NameOf("\x7f"
                   "ELF\x02\x01"),
            "");
  EXPECT_EQ(NameOf("frame,time\n"), "");
}

TEST_F(RecordingFormatsTest, OtherFilesAreSaidToBeWhatTheyAre) {
  const auto format_of = [&](const std::string& content) {
    return [file = Write(content)] { FormatOfContent(file); };
  };
  EXPECT_THAT(format_of("<Robot/>"), ThrowsMessage<Error>(HasSubstr("the root <Robot>")));
  EXPECT_THAT(format_of("version https://git-lfs.github.com/spec/v1\n"),
              ThrowsMessage<Error>(HasSubstr("Git LFS pointer")));
  EXPECT_THAT(format_of("Kaydara FBX Binary  "), ThrowsMessage<Error>(HasSubstr("as BVH")));
  EXPECT_THAT(format_of("PK\x03\x04 archive/data.pkl"), ThrowsMessage<Error>(HasSubstr("PyTorch")));
  EXPECT_THAT(format_of("\x80\x04\x95 and so on"), ThrowsMessage<Error>(HasSubstr("pickle")));
  EXPECT_THAT(format_of("; FBX 7.3.0 project file\n"), ThrowsMessage<Error>(HasSubstr("as BVH")));
  EXPECT_THAT(format_of("frame,time\n"), ThrowsMessage<Error>(HasSubstr("is text")));
  // C3D's reader says what is wrong with other bytes.
  EXPECT_STREQ(FormatOfContent(Write("\x7f"
                                     "ELF\x02\x01"))
                   .name,
               "C3D");
}

}  // namespace
}  // namespace mmm_converter
