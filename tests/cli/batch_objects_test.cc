// SPDX-License-Identifier: MIT
// batch: recordings of rigid objects, with the model that the motion names.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/cli/batch_manifest.h"
#include "tests/cli/moving_object.h"
#include "tests/cli/program.h"
#include "tests/common/retarget/biped.h"

namespace mmm_converter {
namespace {

using ::testing::HasSubstr;
using testing::ReadText;
using testing::RunProgram;
using testing::TestFolder;
using testing::WriteText;

constexpr double kMarkers[3][3] = {{0, 20, 0}, {160, -10, 30}, {10, 90, 50}};  // [mm]

std::string ObjectsOut() { return TestFolder() + "/out"; }

void WriteModel() {
  std::string xml = "<Robot Type=\"box\" RootNode=\"r\"><RobotNode name=\"r\">";
  for (int i = 0; i < 3; ++i) {
    xml += fmt::format(
        "<Sensor type=\"position\" name=\"box_{}\"><Transform><Translation x=\"{}\" y=\"{}\" "
        "z=\"{}\"/></Transform></Sensor>",
        i, kMarkers[i][0], kMarkers[i][1], kMarkers[i][2]);
  }
  WriteText(TestFolder() + "/models/box.xml", xml + "</RobotNode></Robot>\n");
}

// A box that moves along x, whose motion names its model.
std::string WriteManifest() {
  std::string xml =
      "<MMM version=\"2.0\"><Motion name=\"box\" type=\"object\"><Model path=\"models/box.xml\"/>"
      "<Sensors><Sensor type=\"MoCapMarker\" version=\"1.0\"><Configuration/><Data>\n";
  for (int k = 0; k < 30; ++k) {
    xml += fmt::format("<Measurement timestep=\"{:.2f}\">", 0.01 * k);
    for (int i = 0; i < 3; ++i) {
      xml += fmt::format("<MarkerPosition name=\"box_{}\">{} {} {}</MarkerPosition>", i,
                         kMarkers[i][0] + k, kMarkers[i][1], kMarkers[i][2]);
    }
    xml += "</Measurement>\n";
  }
  WriteText(TestFolder() + "/box.xml", xml + "</Data></Sensor></Sensors></Motion></MMM>\n");
  std::filesystem::create_directories(TestFolder() + "/models");
  WriteModel();
  std::string manifest = TestFolder() + "/manifest.xml";
  WriteText(manifest, "<Batch config='s2kf_default'><Recording file='box.xml'/></Batch>\n");
  return manifest;
}

std::string Resume(const std::string& manifest) {
  const auto run =
      RunProgram({"batch", manifest, "-o", ObjectsOut(), "--resume", "--reports", "none"});
  return run.out + run.err;
}

TEST(BatchObjects, AnObjectIsConverted) {
  const auto run = RunProgram({"batch", WriteManifest(), "-o", ObjectsOut()});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("1 recordings, 1 converted, 0 failed, 0 missing"));
  const auto line = nlohmann::json::parse(ReadText(ObjectsOut() + "/results.jsonl"));
  EXPECT_EQ(line["state"], "converted");
  EXPECT_TRUE(line["height_m"].is_null());
  EXPECT_TRUE(line["mass_source"].is_null());
  EXPECT_LT(line["distance_mm"]["mean"], 1);
}

TEST(BatchObjects, RobotsTakeThemAlong) {
  WriteText(TestFolder() + "/box.xml", testing::SlidingBox("m.xml", 50));
  WriteText(TestFolder() + "/m.xml", "<Robot/>");
  const std::string manifest = testing::WriteManifest(
      1, testing::QuickConverter() + " robot='biped.urdf' robotObjects='box.xml'");
  testing::BipedShape shape;
  shape.has_legs = false;
  WriteText(TestFolder() + "/biped.urdf", testing::BipedText(shape));
  EXPECT_THAT(Resume(manifest), HasSubstr("--objects needs a robot with legs"));
  EXPECT_FALSE(std::filesystem::exists(ObjectsOut() + "/motions/0.xml"));
  WriteText(TestFolder() + "/biped.urdf", testing::BipedText({}));
  EXPECT_THAT(Resume(manifest), HasSubstr("1 converted, 0 failed in"));
  EXPECT_THAT(Resume(manifest), HasSubstr("0 converted, 0 failed, 1 unchanged"));
  WriteText(TestFolder() + "/m.xml", "<Robot/><!-- another -->");  // gives its size
  EXPECT_THAT(Resume(manifest), HasSubstr("1 converted, 0 failed in"));
}

TEST(BatchObjects, ResumeNoticesAChangeOfTheModelThatTheMotionNames) {
  const std::string manifest = WriteManifest();
  EXPECT_THAT(Resume(manifest), HasSubstr("1 converted, 0 failed in"));
  EXPECT_THAT(Resume(manifest), HasSubstr("0 converted, 0 failed, 1 unchanged"));
  const std::string model = TestFolder() + "/models/box.xml";
  WriteText(model, ReadText(model) + "<!-- another -->");
  EXPECT_THAT(RunProgram({"batch", manifest, "-o", ObjectsOut(), "--merge"}).out,
              HasSubstr("0 converted, 0 failed, 1 missing"));
  EXPECT_THAT(Resume(manifest), HasSubstr("1 converted, 0 failed in"));
  std::filesystem::remove(model);
  EXPECT_THAT(Resume(manifest), HasSubstr("0 converted, 1 failed in"));
}

}  // namespace
}  // namespace mmm_converter
