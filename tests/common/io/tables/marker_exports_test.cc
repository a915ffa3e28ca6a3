// SPDX-License-Identifier: MIT
// Tables that motion capture programs export: Nexus, Motive, QTM.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "common/io/tables/motive_csv.h"
#include "common/io/tables/nexus_csv.h"
#include "common/io/tables/qtm_tsv.h"
#include "common/support/error.h"

namespace mmm_converter {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

using ParseExport = MarkerTable (*)(std::string_view, const std::string&, Warnings*);

std::string ExportMessageOf(ParseExport parse, const std::string& text) {
  try {
    parse(text, "walk.csv", nullptr);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

std::string WithReplaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size()) {
    text.replace(at, what.size(), by);
  }
  return text;
}

const char kNexus[] =
    "Devices\n1000\n,,Plate - Force,,\nFrame,Sub Frame,Fx,Fy,Fz\n,,N,N,N\n1,0,1,2,3\n1,1,1,2,3\n\n"
    "Trajectories\n100\n,,Ann:LASI,,,Ann:RASI,,,,,\nFrame,Sub Frame,X,Y,Z,X,Y,Z\n"
    ",,mm,mm,mm,mm,mm,mm\n"
    "143,0,1,2,3,4,5,6\n144,0,1.5,2.5,3.5,,,\n146,0,7,8,9,10,11,12\n\n"
    "Model Outputs\n100\n,,Ann:LHipAngles,,\nFrame,Sub Frame,X,Y,Z\n,,deg,deg,deg\n143,0,1,1,1\n";

TEST(NexusCsv, ReadsTrajectoriesAmongOtherSections) {
  ASSERT_TRUE(LooksLikeNexusCsv(kNexus));
  Warnings warnings;
  const MarkerTable table = ParseNexusCsv(kNexus, "walk.csv", &warnings);
  EXPECT_THAT(table.markers.labels(), ElementsAre("Ann:LASI", "Ann:RASI"));
  EXPECT_EQ(table.markers.rate(), 100);
  EXPECT_EQ(table.markers.first_time(), 1.42);
  EXPECT_EQ(table.first_frame, 143);
  EXPECT_EQ(table.unit, "mm");
  ASSERT_EQ(table.markers.num_frames(), 4);  // frame 145 is missing
  EXPECT_EQ(table.markers.frame(1).col(0), Eigen::Vector3d(1.5, 2.5, 3.5));
  EXPECT_FALSE(IsSeen(table.markers.frame(1).col(1)));
  EXPECT_FALSE(IsSeen(table.markers.frame(2).col(0)));
  EXPECT_EQ(table.markers.frame(3).col(1), Eigen::Vector3d(10, 11, 12));
  EXPECT_THAT(warnings.texts(), ElementsAre(HasSubstr("1 frame is missing")));
}

TEST(NexusCsv, MayBeSeparatedAsTheLanguageHasIt) {
  const std::string german =
      "Trajectories;;;;\n100;;;;\n;;LASI;;\nFrame;Sub Frame;X;Y;Z\n;;mm;mm;mm\n1;0;-1,5;2;3\n";
  ASSERT_TRUE(LooksLikeNexusCsv(german));
  EXPECT_EQ(ParseNexusCsv(german, "walk.csv").markers.frame(0).col(0), Eigen::Vector3d(-1.5, 2, 3));
  const std::string tabs = "\r\n\r\n" + WithReplaced(WithReplaced(kNexus, ",", "\t"), "\n", "\r\n");
  ASSERT_TRUE(LooksLikeNexusCsv(tabs));
  EXPECT_EQ(ParseNexusCsv(tabs, "walk.csv").markers.num_labels(), 2);
}

TEST(NexusCsv, SaysWhatIsMissing) {
  const std::string outputs = "Model Outputs\n100\n,,A,,\nFrame,Sub Frame,X,Y,Z\n,,,,\n1,0,1,2,3\n";
  EXPECT_TRUE(LooksLikeNexusCsv(outputs));
  EXPECT_THAT(ExportMessageOf(ParseNexusCsv, outputs),
              HasSubstr("without trajectories of markers (it has Model Outputs)"));
  EXPECT_THAT(ExportMessageOf(ParseNexusCsv, "Trajectories\n100\n"), HasSubstr("were expected"));
  EXPECT_THAT(ExportMessageOf(ParseNexusCsv, "Trajectories\n100\n,,\nFrame,Sub Frame\n,,\n1,0\n"),
              HasSubstr("no trajectory has a name"));
  const std::string no_rate = "Trajectories\n\n,,A\nFrame,Sub Frame,X,Y,Z\n,,mm\n1,0,1,2,3\n";
  EXPECT_FALSE(ParseNexusCsv(no_rate, "walk.csv").has_rate);
  EXPECT_FALSE(LooksLikeNexusCsv("Devices of a laboratory\n100\n"));
  EXPECT_FALSE(LooksLikeNexusCsv("time_s,root_x_mm\n0,1\n"));
}

const char kMotive[] =
    "\xEF\xBB\xBF"
    "Format Version,1.23,Take Name,\"Take, 1\",Capture Frame Rate,240.000000,"
    "Export Frame Rate,120.000000,Rotation Type,Quaternion,Length Units,Meters,"
    "Coordinate Space,Global\n\n"
    ",Type,Bone,Bone,Bone,Bone,Bone Marker,Bone Marker,Bone Marker,Marker,Marker,Marker,"
    "Marker,Marker,Marker\n"
    ",Name,Ann:Hip,Ann:Hip,Ann:Hip,Ann:Hip,Ann:WaistLFront,Ann:WaistLFront,Ann:WaistLFront,"
    "Ann:WaistLFront,Ann:WaistLFront,Ann:WaistLFront,Unlabeled 1012,Unlabeled 1012,"
    "Unlabeled 1012\n"
    ",ID,1,1,1,1,\"2A\",\"2A\",\"2A\",2,2,2,3,3,3\n"
    ",Parent,0,0,0,0,1,1,1,,,,,,\n"
    ",,Rotation,Rotation,Rotation,Rotation,Position,Position,Position,Position,Position,Position,"
    "Position,Position,Position\n"
    "Frame,Time (Seconds),X,Y,Z,W,X,Y,Z,X,Y,Z,X,Y,Z\n"
    "0,0.000000,0,0,0,1,9,9,9,0.1,0.9,0.2,,,\n"
    "1,0.008333,0,0,0,1,9,9,9,0.1,0.91,0.2,1,2,3\n";

TEST(MotiveCsv, ReadsMeasuredMarkers) {
  ASSERT_TRUE(LooksLikeMotiveCsv(kMotive));
  Warnings warnings;
  const MarkerTable table = ParseMotiveCsv(kMotive, "walk.csv", &warnings);
  EXPECT_THAT(table.markers.labels(), ElementsAre("Ann:WaistLFront", "*1012"));
  EXPECT_EQ(table.markers.rate(), 120);
  EXPECT_EQ(table.unit, "m");
  ASSERT_EQ(table.markers.num_frames(), 2);
  EXPECT_EQ(table.markers.frame(1).col(0), Eigen::Vector3d(0.1, 0.91, 0.2));
  EXPECT_FALSE(IsSeen(table.markers.frame(0).col(1)));
  EXPECT_THAT(warnings.texts(), IsEmpty());
}

TEST(MotiveCsv, OlderVersionsDoNotSayWhatRowsAre) {
  const std::string old =
      "Format Version,1.2,Take Name,walk,Capture Frame Rate,100,Length Units,Centimeters\n\n"
      ",,Rigid Body,Rigid Body,Rigid Body,Marker,Marker,Marker\n"
      ",,Box,Box,Box,Ann:C7,Ann:C7,Ann:C7\n,,1,1,1,2,2,2\n"
      ",,Position,Position,Position,Position,Position,Position\n"
      "Frame,Time,X,Y,Z,X,Y,Z\n10,0.1,1,1,1,10,150,20\n11,0.11,1,1,1,11,150,20\n";
  const MarkerTable table = ParseMotiveCsv(old, "walk.csv");
  EXPECT_THAT(table.markers.labels(), ElementsAre("Ann:C7"));
  EXPECT_EQ(table.unit, "cm");
  EXPECT_EQ(table.first_frame, 10);
  EXPECT_EQ(table.markers.first_time(), 0.1);
  EXPECT_EQ(table.markers.frame(1).col(0), Eigen::Vector3d(11, 150, 20));
}

TEST(MotiveCsv, TakesSolvedMarkersWhereNoneWasMeasuredAndSaysSo) {
  const std::string solved =
      WithReplaced(WithReplaced(kMotive, ",Marker", ",Other"), "0,9,9,9", "0,9,8,7");
  Warnings warnings;
  const MarkerTable table = ParseMotiveCsv(solved, "walk.csv", &warnings);
  EXPECT_THAT(table.markers.labels(), ElementsAre("Ann:WaistLFront"));
  EXPECT_THAT(warnings.texts(), Contains(HasSubstr("only as Motive's solver has them")));
  const std::string bones = WithReplaced(solved, "Bone Marker", "Bone");
  EXPECT_THAT(ExportMessageOf(ParseMotiveCsv, bones),
              HasSubstr("(it has: Bone, Other); export it with"));
  EXPECT_THAT(ExportMessageOf(ParseMotiveCsv, "Format Version,1.2\n\n,,Marker\n"),
              HasSubstr("without the line Frame"));
}

const char kQtm[] =
    "NO_OF_FRAMES\t3\nNO_OF_CAMERAS\t8\nNO_OF_MARKERS\t2\nFREQUENCY\t200\nNO_OF_ANALOG\t0\n"
    "DESCRIPTION\t--\nTIME_STAMP\t2019-02-20, 10:21:31.123\t12.5\nDATA_INCLUDED\t3D\n"
    "EVENT\tstep\t2\t0.005\nMARKER_NAMES\tL_IAS\tR_IAS\nTRAJECTORY_TYPES\tMeasured\tMixed\n";

TEST(QtmTsv, ReadsRowsWithAndWithoutTimes) {
  const std::string plain =
      std::string(kQtm) + "1\t2\t3\t4\t5\t6\n1\t2\t3\t\t\t\n7\t8\t9\t0\t0\t0\n";
  const std::string timed =
      std::string(kQtm) + "Frame\tTime\tL_IAS X\tL_IAS Y\tL_IAS Z\tR_IAS X\tR_IAS Y\tR_IAS Z\n" +
      "5\t0.02000\t1\t2\t3\t4\t5\t6\n6\t0.02500\t1\t2\t3\t\t\t\n7\t0.03000\t7\t8\t9\t0\t0\t0\n";
  const std::string unnamed =
      std::string(kQtm) +
      "5\t0.02000\t1\t2\t3\t4\t5\t6\n6\t0.02500\t1\t2\t3\t\t\t\n7\t0.03000\t7\t8\t9\t0\t0\t0\n";
  const std::string ended = WithReplaced(plain, "6\n", "6\t\n");
  for (const std::string& text : {plain, timed, unnamed, ended}) {
    ASSERT_TRUE(LooksLikeQtmTsv(text));
    Warnings warnings;
    const MarkerTable table = ParseQtmTsv(text, "walk.tsv", &warnings);
    EXPECT_THAT(table.markers.labels(), ElementsAre("L_IAS", "R_IAS"));
    EXPECT_EQ(table.markers.rate(), 200);
    EXPECT_EQ(table.unit, "mm");
    EXPECT_EQ(table.declared_frames, 3);
    ASSERT_EQ(table.markers.num_frames(), 3);
    EXPECT_EQ(table.markers.frame(0).col(1), Eigen::Vector3d(4, 5, 6));
    EXPECT_EQ(table.markers.frame(2).col(0), Eigen::Vector3d(7, 8, 9));
    EXPECT_FALSE(IsSeen(table.markers.frame(1).col(1)));
    EXPECT_FALSE(IsSeen(table.markers.frame(2).col(1)));
    EXPECT_EQ(table.markers.first_time(), &text == &plain ? 0 : table.markers.first_time());
    EXPECT_THAT(warnings.texts(), IsEmpty());
  }
  EXPECT_EQ(ParseQtmTsv(timed, "walk.tsv").markers.first_time(), 0.02);
  EXPECT_EQ(ParseQtmTsv(timed, "walk.tsv").first_frame, 5);
  EXPECT_EQ(ParseQtmTsv(unnamed, "walk.tsv").first_frame, 5);
  EXPECT_EQ(ParseQtmTsv(plain, "walk.tsv").first_frame, 1);
}

TEST(QtmTsv, SaysWhatIsMissing) {
  EXPECT_THAT(
      ExportMessageOf(ParseQtmTsv, "NO_OF_FRAMES\t3\nDATA_INCLUDED\t6D\nBODY_NAMES\tBox\n1\t2\n"),
      HasSubstr("without MARKER_NAMES (it has 6D data); export 3D data"));
  EXPECT_THAT(ExportMessageOf(ParseQtmTsv, kQtm), HasSubstr("without rows"));
  EXPECT_THAT(ExportMessageOf(ParseQtmTsv, std::string(kQtm) + "1\t2\t3\n"),
              HasSubstr("3 cells in a row for 2 markers"));
}

// Whatever stands in a file, it is read or refused with a message that names it.
TEST(MarkerExports, DamagedFilesAreReadOrRefused) {
  std::mt19937 random(7);
  const std::string qtm = std::string(kQtm) + "1\t2\t3\t4\t5\t6\n1\t2\t3\t4\t5\t6\n";
  int read = 0;
  int refused = 0;
  for (const auto& [parse, text] : {std::pair<ParseExport, std::string>(ParseNexusCsv, kNexus),
                                    std::pair<ParseExport, std::string>(ParseMotiveCsv, kMotive),
                                    std::pair<ParseExport, std::string>(ParseQtmTsv, qtm)}) {
    for (int i = 0; i < 600; ++i) {
      std::string damaged = text;
      for (int change = 0; change < 3; ++change) {
        const std::size_t at = random() % damaged.size();
        if (random() % 3 == 0) damaged.erase(at, 1 + random() % 40);
        if (damaged.empty()) damaged = "1";
        damaged[random() % damaged.size()] = ",;\t\n\r\"e9-.Xx\0"[random() % 13];
      }
      const std::string message = ExportMessageOf(parse, damaged);
      message == "no error" ? ++read : ++refused;
      EXPECT_TRUE(message == "no error" || message.find("walk.csv") == 0) << message;
    }
  }
  EXPECT_GT(read, 100);
  EXPECT_GT(refused, 100);
}

TEST(MarkerExports, TimesThatSkipDoNotAllocate) {
  const std::string far = std::string(kMotive) + "2,900000000.0,0,0,0,1\n";
  EXPECT_THAT(ExportMessageOf(ParseMotiveCsv, far), HasSubstr("mend these, or cut the file there"));
  EXPECT_THAT(ExportMessageOf(ParseNexusCsv, WithReplaced(kNexus, "\n146,0,", "\n1460000000,0,")),
              HasSubstr("mend these, or cut the file there"));
}

}  // namespace
}  // namespace mmm_converter
