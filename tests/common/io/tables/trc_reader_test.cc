// SPDX-License-Identifier: MIT
#include "common/io/tables/trc_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/io/bytes/file_content.h"
#include "common/support/error.h"
#include "tests/support/shared_data.h"

namespace mmm_converter {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const char kHeader[] =
    "PathFileType\t4\t(X/Y/Z)\twalk.trc\n"
    "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumF"
    "rames\n"
    "100\t100\t2\t2\tmm\t100\t1\t2\n";
const char kLabels[] = "Frame#\tTime\tC7\t\t\tR Knee\t\t\n\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n";

std::string TrcMessageOf(const std::string& text) {
  try {
    ParseTrc(text, "walk.trc");
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(TrcReader, ReadsAPlainFile) {
  Warnings warnings;
  const MarkerTable trc =
      ParseTrc(std::string(kHeader) + kLabels +
                   "\n1\t0.00\t1\t2\t3\t4\t5\t6\n2\t0.01\t7\t8\t9\t-1.5e1\t11\t12\n",
               "walk.trc", &warnings);
  EXPECT_THAT(trc.markers.labels(), ElementsAre("C7", "R Knee"));
  EXPECT_EQ(trc.markers.rate(), 100);
  EXPECT_EQ(trc.unit, "mm");
  EXPECT_EQ(trc.first_frame, 1);
  ASSERT_EQ(trc.markers.num_frames(), 2);
  EXPECT_EQ(trc.markers.frame(1).col(1), Eigen::Vector3d(-15, 11, 12));
  EXPECT_THAT(warnings.texts(), IsEmpty());
}

TEST(TrcReader, KeepsColumnsOfMissingMarkers) {
  Warnings warnings;
  const MarkerTable trc =
      ParseTrc(std::string(kHeader) + kLabels +
                   "5\t0.5\t\t\t\t4\t5\t6\n6\t0.51\tNaN\tNaN\tNaN\t \t \t \n"
                   "7\t0.52\t0\t0\t0\t4\t5\n8\t0.53\t9999999\t1\t1\t4\t5\t6\t\t\n",
               "walk.trc", &warnings);
  ASSERT_EQ(trc.markers.num_frames(), 4);
  EXPECT_EQ(trc.first_frame, 5);
  EXPECT_EQ(trc.markers.first_time(), 0.5);
  for (int k = 0; k < 4; ++k) {
    EXPECT_FALSE(IsSeen(trc.markers.frame(k).col(0))) << k;
    EXPECT_EQ(IsSeen(trc.markers.frame(k).col(1)), k == 0 || k == 3) << k;
  }
  EXPECT_THAT(warnings.texts(), ElementsAre(HasSubstr("NumFrames says 2, there are 4")));
}

TEST(TrcReader, UnderstandsWindowsLinesCommasAndDecimalCommas) {
  std::string windows =
      std::string(kHeader) + kLabels + "1\t0,00\t1,5\t2\t3\t4\t5\t6\n2\t0,01\t7\t8\t9\t1\t2\t3\n";
  for (std::size_t at = 0; (at = windows.find('\n', at)) != std::string::npos; at += 2) {
    windows.replace(at, 1, "\r\n");
  }
  EXPECT_EQ(ParseTrc(windows, "walk.trc").markers.frame(0)(0, 0), 1.5);
  const MarkerTable commas = ParseTrc(
      "Frame#,Time,S:C7,,,S:T10,,\n,,X5,Y5,Z5,X6,Y6,Z6\n1,0,1,2,3,4,5,6\n2,0.02,1,2,3,4,5,6\n",
      "walk.csv");
  EXPECT_THAT(commas.markers.labels(), ElementsAre("S:C7", "S:T10"));
  EXPECT_DOUBLE_EQ(commas.markers.rate(), 50);
  EXPECT_EQ(commas.unit, "");
}

std::string Replaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size()) {
    text.replace(at, what.size(), by);
  }
  return text;
}

const char kTrcRows[] = "\n1\t0.00\t1\t2\t3\t4\t5\t6\n2\t0.01\t7\t8\t9\t-15\t11\t12\n";

TEST(TrcReader, LinesMayEndAsOnOldMacintoshes) {
  const std::string plain = std::string(kHeader) + kLabels + kTrcRows;
  ASSERT_TRUE(LooksLikeTrc(Replaced(plain, "\n", "\r")));
  const MarkerTable trc = ParseTrc(Replaced(plain, "\n", "\r"), "walk.trc");
  EXPECT_THAT(trc.markers.labels(), ElementsAre("C7", "R Knee"));
  EXPECT_EQ(trc.markers.rate(), 100);
  ASSERT_EQ(trc.markers.num_frames(), 2);
  EXPECT_EQ(trc.markers.frame(1).col(1), Eigen::Vector3d(-15, 11, 12));
}

TEST(TrcReader, BlanksMaySeparate) {
  const std::string text =
      "PathFileType 4 (X/Y/Z) walk.trc\nDataRate CameraRate NumFrames NumMarkers Units\n"
      "50 50 3 2 mm\nFrame#  Time   C7   T10\n  X1 Y1 Z1 X2 Y2 Z2\n\n"
      " 1  0.00  1 2 3  4 5 6\n 2  0.02  1 2 3\n 3  0.04  7 8 9  NaN NaN NaN\n";
  Warnings warnings;
  const MarkerTable trc = ParseTrc(text, "walk.trc", &warnings);
  EXPECT_THAT(trc.markers.labels(), ElementsAre("C7", "T10"));
  EXPECT_EQ(trc.markers.rate(), 50);
  ASSERT_EQ(trc.markers.num_frames(), 3);
  EXPECT_EQ(trc.markers.frame(0).col(1), Eigen::Vector3d(4, 5, 6));
  EXPECT_FALSE(IsSeen(trc.markers.frame(1).col(0)));  // whose is not told
  EXPECT_EQ(trc.markers.frame(2).col(0), Eigen::Vector3d(7, 8, 9));
  EXPECT_THAT(warnings.texts(), ElementsAre(HasSubstr("1 rows have another number of cells")));
  // With a decimal comma, and a head that tabs separate.
  const std::string comma = Replaced(std::string(kHeader), "2\t2\tmm", "1\t2\tmm") + kLabels +
                            "1 0,00 1,5 2,5 3,5 4 5 6\n";
  EXPECT_EQ(ParseTrc(comma, "walk.trc").markers.frame(0).col(0), Eigen::Vector3d(1.5, 2.5, 3.5));
}

TEST(TrcReader, MarkersWithoutLabelsAreCalledByNumber) {
  for (const char* labels : {"Frame#\tTime\t\t\t\t\t\t\n\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n", ""}) {
    Warnings warnings;
    const MarkerTable trc =
        ParseTrc(std::string(kHeader) + labels + kTrcRows, "walk.trc", &warnings);
    EXPECT_THAT(trc.markers.labels(), ElementsAre("*1", "*2"));
    EXPECT_EQ(trc.markers.frame(1).col(1), Eigen::Vector3d(-15, 11, 12));
    EXPECT_THAT(warnings.texts(), ElementsAre(HasSubstr("they are called *1 to *2")));
  }
}

TEST(TrcReader, NamesMayStandOverEachCoordinate) {
  const std::string head = "PathFileType\t4\t(X/Y/Z)\ta.trc\n";
  const MarkerTable trc = ParseTrc(head +
                                       "Frame#\tTime\tLASI_X\tLASI_Y\tLASI_Z\tC7.x\tC7.y\tC7.z\n\n"
                                       "1\t0\tnan\tnan\tnan\t4\t5\t6\n2\t0.01\t1\t2\t3\t4\t5\t7\n",
                                   "a.trc", nullptr);
  EXPECT_EQ(trc.markers.labels(), (std::vector<std::string>{"LASI", "C7"}));
  EXPECT_EQ(trc.markers.frame(1)(2, 0), 3);
  EXPECT_EQ(trc.markers.frame(1)(2, 1), 7);
  const MarkerTable dense =
      ParseTrc(head +
                   "Frame#\tTime\tLow_X\tTop_Y\tMid_Z\n1\t0\t1\t2\t3\t4\t5\t6\t7\t8\t9\n"
                   "2\t0.01\t1\t2\t3\t4\t5\t6\t7\t8\t9\n",
               "a.trc", nullptr);
  EXPECT_EQ(dense.markers.labels(), (std::vector<std::string>{"Low_X", "Top_Y", "Mid_Z"}));
}

TEST(TrcReader, FramesThatAreMissingAreAGap) {
  Warnings warnings;
  const MarkerTable trc = ParseTrc(Replaced(kHeader, "2\t2\tmm", "3\t2\tmm") + kLabels + kTrcRows +
                                       "5\t0.04\t7\t8\t9\t1\t2\t3\n",
                                   "walk.trc", &warnings);
  ASSERT_EQ(trc.markers.num_frames(), 5);
  EXPECT_EQ(trc.num_rows, 3);
  EXPECT_FALSE(IsSeen(trc.markers.frame(2).col(0)));
  EXPECT_FALSE(IsSeen(trc.markers.frame(3).col(0)));
  EXPECT_EQ(trc.markers.frame(4).col(0), Eigen::Vector3d(7, 8, 9));
  EXPECT_THAT(warnings.texts(), ElementsAre(HasSubstr("2 frames are missing between frames 2 and 5"
                                                      " (0.01 s and 0.04 s)")));
}

TEST(TrcReader, PrefersTheTimeColumnToAWrongRate) {
  Warnings warnings;
  const MarkerTable trc = ParseTrc(
      std::string(kHeader) + kLabels + "1\t0.0\t1\t2\t3\t4\t5\t6\n2\t0.1\t7\t8\t9\t1\t2\t3\n",
      "walk.trc", &warnings);
  EXPECT_DOUBLE_EQ(trc.markers.rate(), 10);
  EXPECT_THAT(warnings.texts(), Contains(HasSubstr("the file says 100 Hz")));
}

TEST(TrcReader, SaysWhatIsMissing) {
  EXPECT_THAT(TrcMessageOf(kHeader), HasSubstr("without rows of data"));
  EXPECT_THAT(TrcMessageOf(std::string(kHeader) + "Frame#\tTime\n1\t0\n"),
              HasSubstr("without columns of markers"));
  EXPECT_THAT(TrcMessageOf(std::string(kHeader) + kLabels), HasSubstr("without rows"));
  EXPECT_FALSE(ParseTrc("Frame#\tTime\tA\n1\t0\t1\t2\t3\n", "a.trc").has_rate);
}

TEST(TrcReader, DoesNotAllocateForCellsThatAreNotThere) {
  std::string text = "Frame#\tTime";
  for (int i = 0; i < 20000; ++i) text += "\tM" + std::to_string(i) + "\t\t";
  text += '\n';
  for (int k = 0; k < 20000; ++k) text += "1\t" + std::to_string(k) + "\n";
  EXPECT_THAT(TrcMessageOf(text), HasSubstr("rows are too short"));
}

TEST(TrcReaderRealFiles, ReadsRealFiles) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const std::string path = testing::SharedData("recordings/trc/motek_T.trc");
  const MarkerTable motek = ParseTrc(ReadFileContent(path), path);
  EXPECT_EQ(motek.markers.num_labels(), 41);
  EXPECT_EQ(motek.markers.num_frames(), 89);
  EXPECT_EQ(motek.markers.rate(), 30);
  EXPECT_EQ(motek.unit, "mm");
  EXPECT_EQ(motek.markers.frame(0)(1, 0), 1639.63722);
  const std::string serve_path = testing::SharedData("recordings/trc/tennis_serve.trc");
  const MarkerTable serve = ParseTrc(ReadFileContent(serve_path), serve_path);
  EXPECT_EQ(serve.markers.num_labels(), 39);
  EXPECT_EQ(serve.markers.num_frames(), 1092);
  EXPECT_EQ(serve.markers.rate(), 50);
  EXPECT_EQ(serve.unit, "m");
}

}  // namespace
}  // namespace mmm_converter
