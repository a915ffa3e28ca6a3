// SPDX-License-Identifier: MIT
#include "common/fit/height_estimate.h"

#include <gtest/gtest.h>

#include "common/io/mmm/mmm_model.h"
#include "common/model/kit_joints.h"
#include "common/model/model_scaling.h"
#include "common/motion/marker_synthesis.h"
#include "common/support/error.h"
#include "tests/support/acrobatics.h"
#include "tests/support/all_indices.h"
#include "tests/support/shared_data.h"

namespace mmm_converter {
namespace {

class HeightEstimateTest : public ::testing::Test {
 protected:
  HeightEstimateTest() {
    for (const std::string& name : KitJointNames()) joints_.push_back(model_.FindJoint(name));
  }

  HeightEstimate Estimate(double height, const MarkerErrors& errors) {
    const KinematicModel person = ScaleWinter(model_, {height, 70, {}});
    const MarkerSequence recording =
        SynthesizeMarkers(person, testing::MakeCartwheel(person), errors, 1);
    // Labels of a synthetic recording are in the order of the model's markers.
    return EstimateHeight(model_, joints_, testing::AllIndices<MarkerIx>(num_markers_),
                          testing::AllIndices<LabelIx>(num_markers_), recording);
  }

  KinematicModel model_ = ReadMmmModel(testing::SourcePath("xml_config/models/mmm.xml"));
  std::vector<int> joints_;
  std::size_t num_markers_ = model_.markers().size();
};

TEST_F(HeightEstimateTest, IsExactWhereMarkersSitAsInTheModel) {
  for (const double height : {1.55, 1.75, 1.95}) {
    // The interval is searched to a millimetre; the weak pull to the natural posture adds another.
    EXPECT_NEAR(Estimate(height, {0, 0, 0.25, 0.0001}).height, height, 0.003);
  }
}

TEST_F(HeightEstimateTest, IsGoodToCentimetresWhereTheyDoNot) {
  for (const double height : {1.55, 1.75, 1.95}) {
    const HeightEstimate estimate = Estimate(height, MarkerErrors{});
    // 53 markers that sit 28 mm off on each axis, on a body of some 0.5 m about its middle.
    EXPECT_NEAR(estimate.height, height, 0.06);
    EXPECT_GT(estimate.mean_distance, 0.02);
    EXPECT_EQ(estimate.frames, 12);
  }
}

TEST_F(HeightEstimateTest, TooFewMarkersAreAnError) {
  num_markers_ = 2;
  try {
    Estimate(1.75, MarkerErrors{});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.remedy(), Remedy::kHeight);
  }
}

}  // namespace
}  // namespace mmm_converter
