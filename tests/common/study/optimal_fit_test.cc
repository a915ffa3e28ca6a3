// SPDX-License-Identifier: MIT
#include "common/study/optimal_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

#include "common/convert/converter_config.h"
#include "common/io/mmm/mmm_model.h"
#include "common/model/forward_kinematics.h"
#include "common/model/model_scaling.h"
#include "common/motion/marker_synthesis.h"
#include "common/motion/synthetic_motion.h"
#include "tests/support/all_indices.h"
#include "tests/support/shared_data.h"

namespace mmm_converter {
namespace {

class OptimalFitTest : public ::testing::Test {
 protected:
  OptimalFitTest() {
    motion_ = MakeHandstand(model_);
    motion_.postures.resize(60);
  }

  Eigen::VectorXd Find(const MarkerSequence& markers) const {
    return OptimalDistances(model_, ResolveJoints(ConverterConfig(), model_),
                            testing::AllIndices<MarkerIx>(markers.num_labels()),
                            testing::AllIndices<LabelIx>(markers.num_labels()), markers);
  }

  const KinematicModel model_ =
      ScaleWinter(ReadMmmModel(testing::SourcePath("xml_config/models/mmm.xml")), {1.8, 75, {}});
  PoseTrajectory motion_;
};

TEST_F(OptimalFitTest, IsNearlyZeroWhereThePostureIsInTheMarkers) {
  const MarkerSequence markers = SynthesizeMarkers(model_, motion_, {0, 0, 0.25, 0}, 1);
  // The weak pull to the natural posture keeps it from being 0.
  EXPECT_LT(Find(markers).maxCoeff(), 1e-4);
}

TEST_F(OptimalFitTest, IsBelowTheDistanceOfTheTrueMotion) {
  const MarkerSequence markers = SynthesizeMarkers(model_, motion_, MarkerErrors{}, 1);
  const Eigen::VectorXd optimum = Find(markers);
  for (int k = 0; k < motion_.num_frames(); ++k) {
    const Eigen::Matrix3Xd p_WM = MarkerPositions(model_, ModelPosture(model_, motion_, k));
    EXPECT_LT(optimum[k], (markers.frame(k) - p_WM).colwise().norm().mean()) << k;
  }
}

TEST_F(OptimalFitTest, FramesWithoutMarkersHaveNone) {
  MarkerSequence markers = SynthesizeMarkers(model_, motion_, {0, 0, 0.25, 0}, 1);
  markers.frame(0).setConstant(std::numeric_limits<double>::quiet_NaN());
  markers.frame(30).setConstant(std::numeric_limits<double>::quiet_NaN());
  const Eigen::VectorXd optimum = Find(markers);
  EXPECT_TRUE(std::isnan(optimum[0]));
  EXPECT_TRUE(std::isnan(optimum[30]));
  EXPECT_LT(optimum[31], 1e-4);
}

}  // namespace
}  // namespace mmm_converter
