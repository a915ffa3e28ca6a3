// SPDX-License-Identifier: MIT
// The filter against the paper's equations written down plainly, one sample at a time [S15, S13].
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "common/motion/marker_synthesis.h"
#include "common/motion/synthetic_motion.h"
#include "plugins/s2kf/lcd_sampling.h"
#include "plugins/s2kf/marker_filter.h"
#include "tests/plugins/s2kf/tracking_run.h"

namespace mmm_converter::s2kf {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Update of a belief with all markers seen. form: what of the covariance of z is kept.
void PlainUpdate(const MarkerKinematics& kinematics, const S2kfSettings& settings,
                 const MatrixXd& half_samples, const VectorXd& z, Belief* belief) {
  const JointLimitTransform transform(settings.limits, kinematics.lower(), kinematics.upper());
  MarkerJacobian at = kinematics.MakeJacobian();
  const Eigen::Index n = half_samples.rows();
  MatrixXd samples(n, 2 * half_samples.cols() + 1);
  samples << half_samples, -half_samples, VectorXd::Zero(n);
  const MatrixXd L = belief->P.llt().matrixL();
  MatrixXd h(z.size(), samples.cols());
  for (Eigen::Index i = 0; i < samples.cols(); ++i) {
    Belief x = *belief;
    Move(L * samples.col(i), settings.root, &x);
    VectorXd angles(x.parameters.size());
    for (int j = 0; j < angles.size(); ++j) angles[j] = transform.Angle(j, x.parameters[j]);
    kinematics.ComputeMarkers(x.position, x.orientation.toRotationMatrix(), angles, &at);
    h.col(i) = at.p_WM.reshaped();
  }
  const VectorXd mean = h.rowwise().mean();
  const MatrixXd d = h.colwise() - mean;
  MatrixXd C_zz = d * d.transpose() / static_cast<double>(samples.cols());
  const MatrixXd C_xz = L * samples * d.transpose() / static_cast<double>(samples.cols());
  if (settings.update == UpdateForm::kRegression) {
    const MatrixXd linear = C_xz.transpose() * belief->P.ldlt().solve(C_xz);
    C_zz = linear + MatrixXd((C_zz - linear).diagonal().asDiagonal());
  }
  C_zz.diagonal().array() += settings.marker_deviation * settings.marker_deviation;
  const MatrixXd K = C_zz.ldlt().solve(C_xz.transpose()).transpose();
  Move(K * (z - mean), settings.root, belief);
  const MatrixXd P = belief->P - K * C_xz.transpose();
  belief->P = 0.5 * (P + P.transpose());
}

class PlainFilterTest : public ::testing::TestWithParam<UpdateForm> {};

TEST_P(PlainFilterTest, TheFastFilterIsTheSame) {
  const KinematicModel model = ScaledReferenceModel(1.8);
  const MarkerSequence markers =
      SynthesizeMarkers(model, MakeHandstand(model), MarkerErrors{}, 1).Slice(200, 230);
  const MarkerKinematics kinematics(model, MotionJoints(model, 40),
                                    MarkerIndices(AssignAll(model, markers)));
  S2kfSettings settings;
  settings.update = GetParam();
  settings.iterations = 1;
  settings.robust_distance = 0;
  MarkerFilter filter(kinematics, settings, VectorXd::Ones(kinematics.num_markers()));
  Posture start = ModelPosture(model, MakeHandstand(model), 200);
  start.joint_angles = VectorXd(start.joint_angles(kinematics.joints()));
  Belief fast;
  filter.StartAt(start, &fast);
  Belief plain = fast;
  UpdateOutcome outcome = filter.MakeOutcome();
  const MatrixXd half_samples = LcdHalfSamples(kinematics.num_dofs(), settings.samples);
  MarkerJacobian at = kinematics.MakeJacobian();
  const auto place = [&](const Belief& belief) {
    Posture q;
    filter.ToPosture(belief, &q);
    kinematics.ComputeMarkers(q.position, q.orientation.toRotationMatrix(), q.joint_angles, &at);
    return Eigen::Matrix3Xd(at.p_WM);
  };
  double moved = 0;
  for (int k = 0; k < markers.num_frames(); ++k) {
    const Eigen::Matrix3Xd z = markers.frame(k);
    const Eigen::Matrix3Xd before = place(plain);
    filter.Predict(0.01, &fast);
    filter.Predict(0.01, &plain);
    filter.Update(z, &fast, &outcome);
    PlainUpdate(kinematics, settings, half_samples, z.reshaped(), &plain);
    // What the project promises of its fast path.
    EXPECT_LT((place(fast) - place(plain)).cwiseAbs().maxCoeff(), 1e-9) << "frame " << k;
    moved = std::max(moved, (place(plain) - before).cwiseAbs().maxCoeff());
  }
  EXPECT_GT(moved, 0.01);
}

INSTANTIATE_TEST_SUITE_P(Forms, PlainFilterTest,
                         ::testing::Values(UpdateForm::kExact, UpdateForm::kRegression));

}  // namespace
}  // namespace mmm_converter::s2kf
