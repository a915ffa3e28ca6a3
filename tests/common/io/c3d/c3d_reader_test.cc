// SPDX-License-Identifier: MIT
#include "common/io/c3d/c3d_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numeric>

#include "common/support/error.h"
#include "tests/support/shared_data.h"

namespace mmm_converter {
namespace {

using ::mmm_converter::testing::SharedData;
using nlohmann::json;
using ::testing::Contains;
using ::testing::HasSubstr;

// expected.json keeps 7 significant digits; sums are over up to 1e5 numbers kept so.
constexpr double kSampleTolerance = 1e-6;
constexpr double kSumTolerance = 1e-6;

bool IsNear(double actual, double expected, double relative) {
  return std::abs(actual - expected) <= relative * std::max(std::abs(expected), 1.0);
}

json Expected() {
  std::ifstream stream(SharedData("recordings/expected.json"));
  return json::parse(stream);
}

const char* ProcessorName(C3dProcessor processor) {
  switch (processor) {
    case C3dProcessor::kIntel:
      return "intel";
    case C3dProcessor::kDec:
      return "dec";
    default:
      return "mips";
  }
}

void ExpectHeader(const C3dInfo& info, const Warnings& warnings, const json& expected) {
  EXPECT_EQ(ProcessorName(info.layout.processor), expected["processor"]);
  EXPECT_EQ(info.layout.floats ? "float" : "int", expected["format"]);
  EXPECT_EQ(info.layout.points, expected["points"]);
  EXPECT_EQ(info.layout.frames, expected["frames"]);
  EXPECT_EQ(info.layout.first_frame, expected["first"]);
  EXPECT_EQ(info.layout.rate, expected["rate"]);
  EXPECT_EQ(info.unit, expected["units"]);
  EXPECT_NEAR(info.layout.scale, std::abs(expected["scale"].get<double>()), 1e-8);  // 8 digits
  const std::vector<std::string> labels = expected["labels"];
  EXPECT_EQ(std::vector<std::string>(info.labels.begin(), info.labels.begin() + labels.size()),
            labels);
  const int num_labels = expected["nlabels"];
  if (num_labels != info.layout.points) {
    EXPECT_THAT(warnings.texts(), Contains(HasSubstr(std::to_string(num_labels) + " labels for")));
  }
}

void ExpectSamples(C3dReader& reader, const json& samples) {
  for (const json& sample : samples) {
    const std::vector<C3dPoint> points = reader.ReadFrame(sample[0]);
    const C3dPoint& point = points.at(sample[1]);
    EXPECT_EQ(reader.info().labels.at(sample[1]), sample[2]);
    EXPECT_TRUE(point.valid) << sample;
    for (int i = 0; i < 3; ++i) {
      EXPECT_TRUE(IsNear(point.position[i], sample[3 + i], kSampleTolerance))
          << point.position[i] << " in " << sample;
    }
    EXPECT_NEAR(point.residual, sample[6].get<double>(), 1e-5) << sample;  // kept with 5 decimals
    EXPECT_EQ(point.cameras, sample[7]) << sample;
  }
}

/// The stored points frame by frame, and the same as a sequence.
void ExpectAllPoints(C3dReader& reader, const json& expected) {
  const C3dInfo& info = reader.info();
  std::vector<int> all(info.layout.points);
  std::iota(all.begin(), all.end(), 0);
  const MarkerSequence sequence = reader.ReadPoints(all, info.labels, info.layout.rate);
  int invalid = 0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int differing = 0;
  for (int k = 0; k < info.layout.frames; ++k) {
    const std::vector<C3dPoint> points = reader.ReadFrame(k);
    for (int i = 0; i < info.layout.points; ++i) {
      const C3dPoint& point = points[i];
      if (point.valid) sum += point.position;
      invalid += !point.valid;
      const bool seen = point.valid && !point.position.isZero(0) &&
                        point.position.lpNorm<Eigen::Infinity>() <= 1e6;
      const Eigen::Vector3d p = sequence.frame(k).col(i);
      differing += seen ? p != point.position : !p.array().isNaN().all();
    }
  }
  EXPECT_EQ(differing, 0);
  EXPECT_EQ(invalid, expected["invalid"]);
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(IsNear(sum[i], expected["sum_xyz_valid"][i], kSumTolerance)) << sum.transpose();
  }
}

TEST(C3dReaderRealFiles, ReadsEveryRealFileAsAnIndependentReaderDoes) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  int files = 0;
  const json all = Expected();
  for (const auto& [name, expected] : all.items()) {
    SCOPED_TRACE(name);
    if (name == "synthetic/bad_hdr_points65535.c3d") continue;  // see TakesTheNumberOfPoints...
    Warnings warnings;
    C3dReader reader(SharedData("recordings/" + name), &warnings);
    ExpectHeader(reader.info(), warnings, expected);
    ExpectSamples(reader, expected["samples_frame_index_label_xyz_residual_cam"]);
    ExpectAllPoints(reader, expected);
    ++files;
  }
  EXPECT_EQ(files, 33);
}

}  // namespace
}  // namespace mmm_converter
