// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "common/io/c3d/c3d_reader.h"
#include "common/math/statistics.h"
#include "common/support/atomic_file.h"
#include "tests/cli/program.h"
#include "tests/support/shared_data.h"
#include "tests/support/strict_tables.h"
#include "tests/support/test_folder.h"

namespace mmm_converter {
namespace {

using testing::ReadText;
using testing::RunProgram;
using testing::SharedData;
using testing::TestFolder;

TEST(Angles, AreRefusedOfWhatHasNoAnatomy) {
  const auto result = RunProgram({"convert", testing::SourcePath("examples/handstand.c3d"),
                                  "--model", testing::SourcePath("tests/support/humanoid.urdf"),
                                  "-o", TestFolder() + "/angles_urdf.xml", "--export-angles",
                                  TestFolder() + "/angles_urdf.csv"});
  EXPECT_NE(result.exit_code, 0);
  EXPECT_THAT(result.err, ::testing::HasSubstr("hips and knees"));
}

/// Root mean square of what two series differ by beside a constant [degrees].
double RmsBesideConstant(const std::vector<double>& a, const std::vector<double>& b) {
  double mean = 0, square = 0;
  for (std::size_t i = 0; i < a.size(); ++i) mean += (a[i] - b[i]) / static_cast<double>(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) square += std::pow(a[i] - b[i] - mean, 2);
  return std::sqrt(square / static_cast<double>(a.size()));
}

class AnglesReal : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    MMM_CONVERTER_NEEDS_SHARED_DATA();
    file_ = SharedData(std::string("field/") + GetParam());
    const std::string base = TestFolder() + "/angles_" + GetParam();
    const auto result = RunProgram({"convert", file_, "-c", "s2kf_offline", "-o", base + ".xml",
                                    "--export-angles", base + ".csv"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    table_ = ReadText(base + ".csv");
  }

  /// Ours and those that the file holds, of the frames that have both [degrees].
  double Rms(const std::string& name, const std::string& output, int component) {
    const std::vector<double> ours = Ours(name);
    C3dReader reader(file_);
    const auto& labels = reader.info().labels;
    const auto label = std::find_if(labels.begin(), labels.end(),
                                    [&](const std::string& one) { return one.ends_with(output); });
    if (label == labels.end()) {
      ADD_FAILURE() << "no " << output;
      return 0;
    }
    const auto stored =
        reader.ReadPoints({static_cast<int>(label - labels.begin())}, {output}, 100, true);
    std::vector<double> a, b;
    for (int k = 0; k < std::min(stored.num_frames(), static_cast<int>(ours.size())); ++k) {
      const double angle = stored.frame(k)(component, 0);
      if (!std::isfinite(angle)) continue;
      a.push_back(ours[k]);
      b.push_back(angle);
    }
    EXPECT_GT(a.size(), 50U) << output;
    return RmsBesideConstant(a, b);
  }

 private:
  std::vector<double> Ours(const std::string& name) const {
    std::vector<double> angles;
    for (std::size_t at = table_.find(name); at != std::string::npos;
         at = table_.find(name, at + 1)) {
      angles.push_back(std::stod(table_.substr(at + name.size())));
    }
    return angles;
  }

  std::string file_, table_;
};

// Plug-in Gait has other hip centres, knee axes and axes of the foot: a constant, and some degrees.
TEST_P(AnglesReal, GoWithThoseOfPlugInGait) {
  for (const auto& [side, prefix] : {std::pair{"left", "L"}, std::pair{"right", "R"}}) {
    const auto rms = [&, side = side, prefix = prefix](const char* joint, const char* output,
                                                       int component) {
      return Rms(std::string(joint).insert(std::string(joint).find(',', 1) + 1, side),
                 std::string(prefix) + output, component);
    };
    EXPECT_LT(rms(",hip,,flexion,", "HipAngles", 0), 3);
    EXPECT_LT(rms(",knee,,flexion,", "KneeAngles", 0), 4);
    EXPECT_LT(rms(",hip,,adduction,", "HipAngles", 1), 6);
    EXPECT_LT(Rms(",pelvis,,tilt,", std::string(prefix) + "PelvisAngles", 0), 2);
  }
}

INSTANTIATE_TEST_SUITE_P(Recordings, AnglesReal,
                         ::testing::Values("c3dio_gait-pig.c3d", "btk_FunctionalWalk.c3d",
                                           "c3dio_2198928.c3d", "c3dio_sub_labels.c3d"));

// Vicon's own figures of the recording, of one stride of each foot; ours are of all.
TEST(GaitReal, FiguresAreThoseThatTheFileHolds) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const std::string base = TestFolder() + "/gait";
  const auto result =
      RunProgram({"convert", SharedData("field/c3dio_Vicon_analysis.c3d"), "-c", "s2kf_offline",
                  "-o", base + ".xml", "--export-gait", base + ".json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto summary = nlohmann::json::parse(ReadText(base + ".json"))["summary"];
  const auto near = [&](const char* side, const char* figure, double stored, double share) {
    EXPECT_NEAR(summary[side][figure]["mean"].get<double>(), stored, share * stored)
        << side << " " << figure;
  };
  near("left", "cadence_steps_per_min", 117.455, 0.03);
  near("left", "speed_m_per_s", 1.189, 0.05);
  near("left", "stride_time_s", 1.022, 0.03);
  near("left", "stride_length_m", 1.214, 0.05);
  near("left", "step_length_m", 0.628, 0.08);
  near("left", "foot_off_percent", 58.728, 0.05);
  near("right", "cadence_steps_per_min", 116.883, 0.03);
  near("right", "speed_m_per_s", 1.124, 0.08);
  near("right", "stride_length_m", 1.154, 0.08);
  near("right", "foot_off_percent", 61.282, 0.05);
}

}  // namespace
}  // namespace mmm_converter
