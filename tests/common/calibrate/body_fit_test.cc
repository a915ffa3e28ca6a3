// SPDX-License-Identifier: MIT
#include "common/calibrate/body_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "common/calibrate/frame_equations.h"
#include "common/support/error.h"
#include "common/support/units.h"
#include "tests/support/all_indices.h"
#include "tests/support/synthetic_person.h"
#include "tests/support/test_models.h"

namespace mmm_converter {
namespace {

std::vector<MarkerIx> AllMarkers(const KinematicModel& model) {
  return testing::AllIndices<MarkerIx>(model.markers().size());
}

TEST(FrameEquations, GradientIsThatOfTheCost) {
  const KinematicModel model = testing::ScaledReferenceModel(1.7);
  BodyKinematics kinematics(model, testing::TrackedJoints(model), AllMarkers(model));
  std::mt19937 random(2);
  const Posture posture = testing::RandomPosture(kinematics.kinematics(), 0.8, &random);
  BodyJacobian at = kinematics.MakeJacobian();
  kinematics.Compute(posture, &at);
  Eigen::Matrix3Xd z = at.posture.p_WM;
  for (double& coordinate : z.reshaped()) coordinate += 0.01 * (random() % 100) / 50 - 0.01;
  z.col(3).setConstant(kNaN);
  FrameEquations equations(kinematics, z, Eigen::VectorXd::Constant(z.cols(), 0.005), 0.5);

  BodyEquations body(kinematics);
  equations.Cost(kinematics, posture);
  equations.Linearize(kinematics, posture, &body);
  // By a scale and an offset; of the cost, the gradient is -2 g. Differences over 1e-6 of costs of
  // some 1e2 are good to 1e-4 of slopes of some 1e4.
  constexpr double kStep = 1e-6;
  const auto cost_at = [&](const Body& moved) {
    kinematics.SetBody(moved);
    return equations.Cost(kinematics, posture);
  };
  const Eigen::Index first_scale = 3 * z.cols();
  for (Eigen::Index i = 0; i < kinematics.ModelBody().scales.size(); ++i) {
    Body more = kinematics.ModelBody();
    Body less = more;
    more.scales[i] += kStep;
    less.scales[i] -= kStep;
    const double slope = (cost_at(more) - cost_at(less)) / (2 * kStep);
    EXPECT_NEAR(slope, -2 * body.g[first_scale + i], 1e-4 * (1 + std::abs(slope))) << i;
  }
  for (Eigen::Index m = 0; m < z.cols(); ++m) {
    Body more = kinematics.ModelBody();
    Body less = more;
    more.offsets(1, m) += kStep;
    less.offsets(1, m) -= kStep;
    const double slope = (cost_at(more) - cost_at(less)) / (2 * kStep);
    EXPECT_NEAR(slope, -2 * body.g[3 * m + 1], 1e-4 * (1 + std::abs(slope))) << m;
  }
  EXPECT_EQ(body.g.segment<3>(9).norm(), 0) << "a marker that is not seen says nothing";
}

TEST(FrameEquations, SlopesAreHowAPostureFollowsTheBody) {
  const KinematicModel model = testing::ScaledReferenceModel(1.7);
  BodyKinematics kinematics(model, testing::TrackedJoints(model), AllMarkers(model));
  std::mt19937 random(4);
  const Posture posture = testing::RandomPosture(kinematics.kinematics(), 0.5, &random);
  BodyJacobian at = kinematics.MakeJacobian();
  kinematics.Compute(posture, &at);
  FrameEquations equations(kinematics, at.posture.p_WM,
                           Eigen::VectorXd::Constant(at.posture.p_WM.cols(), 0.005), 1);
  BodyEquations body(kinematics);
  equations.Cost(kinematics, posture);
  NormalEquations solver(kinematics.kinematics());
  const auto step_at = [&](const Eigen::VectorXd& change) -> Eigen::VectorXd {
    equations.Linearize(kinematics, posture, &body);
    equations.Eliminate(0, &body);
    return equations.Step(change, posture, 0, &solver);
  };
  const Eigen::VectorXd none = step_at(Eigen::VectorXd::Zero(body.size()));
  const Eigen::MatrixXd slopes = equations.Slopes();
  Eigen::VectorXd change = Eigen::VectorXd::Zero(body.size());
  for (double& x : change) x = 1e-5 * ((random() % 100) / 50.0 - 1);
  // Linear, but for rounding.
  EXPECT_LT((step_at(change) - none - slopes * change).norm(), 1e-10);
  EXPECT_GT((slopes * change).norm(), 1e-6);
}

/// Frames of a range-of-motion trial, with the postures that the model finds in them.
std::vector<CalibrationFrame> Frames(const KinematicModel& model, const KinematicModel& person,
                                     int count) {
  const PoseTrajectory motion = testing::RangeOfMotion(model, 0.1 * count, 0.7, 3);
  const MarkerSequence recording = testing::RecordPerson(person, motion, 3);
  const std::vector<CalibrationRecording> recordings = {
      {"trial", &recording, testing::AssignAll(model, recording)}};
  std::vector<CalibrationFrame> frames = CandidateFrames(recordings, AllMarkers(model), 10);
  FitPostures(model, testing::TrackedJoints(model), AllMarkers(model), &frames);
  return frames;
}

TEST(FitBody, IsAMinimumWithJointsInsideTheirLimits) {
  const KinematicModel model = testing::ScaledReferenceModel(1.7);
  const KinematicModel person = FitToSubject(model, testing::DrawPerson(model, 5));
  std::vector<CalibrationFrame> frames = Frames(model, person, 30);
  BodyKinematics kinematics(model, testing::TrackedJoints(model), AllMarkers(model));
  Body body = kinematics.ModelBody();
  const Eigen::VectorXd ones =
      Eigen::VectorXd::Ones(static_cast<Eigen::Index>(model.markers().size()));
  const BodyFitResult fit = FitBody(&kinematics, {}, ones, &frames, &body);
  EXPECT_TRUE(fit.converged);
  const MarkerKinematics& limits = kinematics.kinematics();
  for (const CalibrationFrame& frame : frames) {
    EXPECT_TRUE((frame.posture.joint_angles.array() >= limits.lower().array()).all());
    EXPECT_TRUE((frame.posture.joint_angles.array() <= limits.upper().array()).all());
  }
  // Started where it ended it gains no more than what it stops at.
  const BodyFitResult again = FitBody(&kinematics, {}, ones, &frames, &body);
  EXPECT_LE(again.cost, fit.cost);
  EXPECT_LT(fit.cost - again.cost, 0.5) << "half a unit of -2 log p: the data can't tell";
}

// A constant in an angle fits as well with markers elsewhere: the mean is what places tell.
TEST(FitBody, KeepsTheMeanPostureThatIsKnown) {
  const KinematicModel model = testing::ScaledReferenceModel(1.7);
  const KinematicModel person = FitToSubject(model, testing::DrawPerson(model, 5));
  std::vector<CalibrationFrame> frames = Frames(model, person, 30);
  BodyKinematics kinematics(model, testing::TrackedJoints(model), AllMarkers(model));
  const Eigen::VectorXd ones =
      Eigen::VectorXd::Ones(static_cast<Eigen::Index>(model.markers().size()));
  const auto knee = std::distance(kinematics.joints().begin(),
                                  std::find(kinematics.joints().begin(), kinematics.joints().end(),
                                            model.FindJoint("LKx_joint")));
  constexpr double kBent = 4 / kDegrees;
  for (CalibrationFrame& frame : frames) {
    frame.by_places = frame.posture;
    frame.by_places.joint_angles[knee] -= kBent;
  }
  const auto mean_with = [&](double deviation) {
    std::vector<CalibrationFrame> fitted = frames;
    Body body = kinematics.ModelBody();
    CalibrationOptions options;
    options.mean_posture_deviation = deviation;
    EXPECT_TRUE(FitBody(&kinematics, options, ones, &fitted, &body).converged);
    double mean = 0;
    for (std::size_t k = 0; k < frames.size(); ++k) {
      mean += (fitted[k].posture.joint_angles - frames[k].by_places.joint_angles)[knee] /
              static_cast<double>(frames.size());
    }
    return mean;
  };
  const double alone = std::abs(mean_with(0));
  EXPECT_GT(alone, kBent / 2);
  EXPECT_LT(std::abs(mean_with(1 / kDegrees)), alone);
  EXPECT_LT(std::abs(mean_with(0.1 / kDegrees)), alone / 10);
}

TEST(FitBody, EndsBetweenTwoSteps) {
  const KinematicModel model = testing::ScaledReferenceModel(1.7);
  const KinematicModel person = FitToSubject(model, testing::DrawPerson(model, 5));
  std::vector<CalibrationFrame> frames = Frames(model, person, 20);
  BodyKinematics kinematics(model, testing::TrackedJoints(model), AllMarkers(model));
  Body body = kinematics.ModelBody();
  CalibrationOptions options;
  int calls = 0;
  options.between_steps = [&calls] {
    if (++calls == 2) throw Error("enough");
  };
  const Eigen::VectorXd ones =
      Eigen::VectorXd::Ones(static_cast<Eigen::Index>(model.markers().size()));
  EXPECT_THROW(FitBody(&kinematics, options, ones, &frames, &body), Error);
  EXPECT_EQ(calls, 2);
  EXPECT_THROW(FitPostures(model, testing::TrackedJoints(model), AllMarkers(model), &frames,
                           [] { throw Error("enough"); }),
               Error);
}

TEST(FitBody, DeviationsFallWithFramesAndNeverExceedThePrior) {
  const KinematicModel model = testing::ScaledReferenceModel(1.7);
  const KinematicModel person = FitToSubject(model, testing::DrawPerson(model, 5));
  const Eigen::VectorXd ones =
      Eigen::VectorXd::Ones(static_cast<Eigen::Index>(model.markers().size()));
  const auto fit_of = [&](int count) {
    std::vector<CalibrationFrame> frames = Frames(model, person, count);
    BodyKinematics kinematics(model, testing::TrackedJoints(model), AllMarkers(model));
    Body body = kinematics.ModelBody();
    return FitBody(&kinematics, {}, ones, &frames, &body);
  };
  const BodyFitResult few = fit_of(20);
  const BodyFitResult many = fit_of(40);
  EXPECT_LT(many.deviations.scales.mean(), few.deviations.scales.mean());
  EXPECT_LT(many.deviations.offsets.mean(), few.deviations.offsets.mean());
  EXPECT_TRUE((few.deviations.scales.array() <= few.prior_scale_deviations.array()).all());
}

}  // namespace
}  // namespace mmm_converter
