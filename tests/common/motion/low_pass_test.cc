// SPDX-License-Identifier: MIT
#include "common/motion/low_pass.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "common/math/rotation.h"

namespace mmm_converter {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
constexpr double kPi = std::numbers::pi;

MatrixXd Sine(int frames, double rate, double frequency) {
  MatrixXd values(frames, 1);
  for (int k = 0; k < frames; ++k) {
    values(k, 0) = std::sin(2 * kPi * frequency * (k - 0.5 * frames) / rate);
  }
  return values;
}

TEST(LowPass, PassesConstantAccelerationsUnchangedToTheEnds) {
  for (const double rate : {10.0, 100.0, 1000.0}) {
    MatrixXd values(400, 2);
    for (int k = 0; k < 400; ++k) {
      const double t = k / rate;
      values.row(k) << 3 - 2 * t + 4.9 * t * t, 1000;
    }
    // At 1000 Hz and 3 Hz lambda is 1e10: that times the third differences' rounding.
    EXPECT_LT((LowPassed(values, rate, 3) - values).cwiseAbs().maxCoeff(), 1e-6) << rate;
  }
}

TEST(LowPass, PassesAsAButterworthFilterWithoutAPhase) {
  constexpr double kRate = 200;
  constexpr double kCutoff = 6;
  for (const double frequency : {1.0, 3.0, 6.0, 12.0, 30.0}) {
    const MatrixXd values = Sine(2000, kRate, frequency);
    const auto ratio = [&](double f) { return std::sin(kPi * f / kRate); };
    const double gain =
        1 / (1 + (std::numbers::sqrt2 - 1) * std::pow(ratio(frequency) / ratio(kCutoff), 6));
    const MatrixXd passed = LowPassed(values, kRate, kCutoff);
    // In the middle: what the ends do has died away by more than 1e-12.
    EXPECT_LT((passed - gain * values).middleRows(900, 200).cwiseAbs().maxCoeff(), 1e-9)
        << frequency;
  }
  EXPECT_NEAR(LowPassed(Sine(2000, kRate, kCutoff), kRate, kCutoff)
                  .middleRows(900, 200)
                  .cwiseAbs()
                  .maxCoeff(),
              1 / std::numbers::sqrt2, 0.01);  // sampled at 33 places a period
}

TEST(LowPass, LeavesAFewFramesAlone) {
  for (int frames = 0; frames < 4; ++frames) {
    const MatrixXd values = MatrixXd::Random(frames, 2);
    EXPECT_EQ(LowPassed(values, 100, 6), values);
  }
}

PoseTrajectory Spinning(const Eigen::Quaterniond& before, const Eigen::Quaterniond& after) {
  PoseTrajectory motion;
  motion.rate = 100;
  motion.first_time = 2;
  motion.joint_names = {"a_joint"};
  for (int k = 0; k < 300; ++k) {
    Posture q;
    q.position = Vector3d(0, 0, 0.01 * k);
    // Two turns a second, noisy; every other quaternion with the other sign.
    const double angle = 4 * kPi * k / 100.0 + 0.05 * std::sin(2 * kPi * 30 * k / 100.0);
    q.orientation = before * Exp(angle * Vector3d(0, 0.6, 0.8)) * after;
    if (k % 2 == 1) q.orientation.coeffs() *= -1;
    q.joint_angles = Eigen::VectorXd::Constant(1, 0.3);
    motion.postures.push_back(q);
  }
  motion.velocities = MatrixXd::Ones(7, 300);
  return motion;
}

TEST(LowPass, LetsASpinPassAndRemovesItsNoise) {
  const Eigen::Quaterniond one = Eigen::Quaterniond::Identity();
  const PoseTrajectory smooth = LowPassed(Spinning(one, one), 6);
  EXPECT_EQ(smooth.velocities.size(), 0);
  EXPECT_EQ(smooth.first_time, 2);
  for (int k = 100; k < 200; ++k) {
    const Eigen::Quaterniond true_orientation = Exp(4 * kPi * k / 100.0 * Vector3d(0, 0.6, 0.8));
    const double error = Log(smooth.postures[k].orientation * true_orientation.conjugate()).norm();
    // Of the noise at 30 Hz 1/2000 remains; on a quaternion at 1 Hz it sits at 29 and 31 Hz.
    EXPECT_LT(error, 0.05 / 1000);
    EXPECT_NEAR(smooth.postures[k].position.z(), 0.01 * k, 1e-9);
  }
}

TEST(LowPass, TreatsAllFramesOfReferenceAlike) {
  const Eigen::Quaterniond one = Eigen::Quaterniond::Identity();
  const Eigen::Quaterniond before = Exp({0.5, -1.7, 0.3});
  const Eigen::Quaterniond after = Exp({-2, 0.1, 1});
  const PoseTrajectory plain = LowPassed(Spinning(one, one), 6);
  const PoseTrajectory turned = LowPassed(Spinning(before, after), 6);
  for (int k = 0; k < 300; ++k) {
    const Eigen::Quaterniond expected = before * plain.postures[k].orientation * after;
    EXPECT_LT(Log(turned.postures[k].orientation * expected.conjugate()).norm(), 1e-9);
  }
}

}  // namespace
}  // namespace mmm_converter
