// SPDX-License-Identifier: MIT
// Least squares on a real recording.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "common/io/mmm/mmm_motion.h"
#include "common/model/forward_kinematics.h"
#include "common/motion/marker_residuals.h"
#include "common/motion/marker_synthesis.h"
#include "plugins/jacobian/jacobian_converter.h"
#include "plugins/s2kf/s2kf_converter.h"
#include "tests/plugins/s2kf/tracking_run.h"
#include "tests/support/shared_data.h"

namespace mmm_converter::jacobian {
namespace {

// KIT's own solution is in the same file, for the same markers; all are measured on one model.
TEST(RealKitBimanualTest, LeastSquaresIsBelowKitsOwnSolutionAndNotAboveTheFilter) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const MmmMotionFile file = ReadMmmMotionFile(
      testing::SharedData("mmm/kit_bimanual_10hz/Cut_files_motions_3021_Cut1_c_0_05cm_03.xml"));
  const MmmMotion* recorded = file.Find("true_1723");
  ASSERT_NE(recorded, nullptr);
  const KinematicModel model = s2kf::ScaledReferenceModel(recorded->size.height.value());
  const std::vector<int> joints = s2kf::MotionJoints(model, 44);
  const auto assignments = s2kf::AssignAll(model, recorded->markers);
  ASSERT_EQ(assignments.size(), 53u);

  const TrackingSetup setup = s2kf::SetupOf(model, joints, assignments);
  const ConversionResult fit = JacobianConverter(setup, {}).Convert(recorded->markers, nullptr);
  const ConversionResult filter =
      s2kf::S2kfConverter(setup, {}).Convert(recorded->markers, nullptr);

  Eigen::MatrixXd stored(fit.residuals.rows(), fit.residuals.cols());
  for (int k = 0; k < recorded->markers.num_frames(); ++k) {
    const Eigen::Matrix3Xd p_WM =
        MarkerPositions(model, ModelPosture(model, recorded->trajectory, k));
    for (std::size_t i = 0; i < assignments.size(); ++i) {
      stored(static_cast<Eigen::Index>(i), k) =
          (recorded->markers.frame(k).col(assignments[i].label) - p_WM.col(assignments[i].marker))
              .norm();
    }
  }
  const double fit_mean = SummarizeResiduals(fit.residuals).mean;
  const double filter_mean = SummarizeResiduals(filter.residuals).mean;
  const double stored_mean = SummarizeResiduals(stored).mean;
  std::printf("[ measured ] least squares %.2f mm, filter %.2f, KIT's own solution %.2f\n",
              1e3 * fit_mean, 1e3 * filter_mean, 1e3 * stored_mean);
  EXPECT_LT(fit_mean, stored_mean);
  // Least in squares; in mean distance a filter may be below by a few hundredths of a millimetre.
  EXPECT_LT(fit_mean, filter_mean + 5e-5);
  for (const Posture& posture : fit.trajectory.postures) {
    for (std::size_t j = 0; j < joints.size(); ++j) {
      EXPECT_GE(posture.joint_angles[j], model.joint(joints[j]).lower);
      EXPECT_LE(posture.joint_angles[j], model.joint(joints[j]).upper);
    }
  }
}

}  // namespace
}  // namespace mmm_converter::jacobian
