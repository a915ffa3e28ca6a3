// SPDX-License-Identifier: MIT
#include "common/calibrate/body_kinematics.h"
#include "tests/support/all_indices.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "tests/support/synthetic_person.h"
#include "tests/support/test_models.h"

namespace mmm_converter {
namespace {

class BodyKinematicsTest : public ::testing::Test {
 protected:
  static std::vector<MarkerIx> AllMarkers(const KinematicModel& model) {
    return testing::AllIndices<MarkerIx>(model.markers().size());
  }

  BodyKinematicsTest()
      : model_(testing::ScaledReferenceModel(1.7)),
        kinematics_(model_, testing::TrackedJoints(model_), AllMarkers(model_)),
        body_(kinematics_.ModelBody()) {
    std::mt19937 random(1);
    posture_ = testing::RandomPosture(kinematics_.kinematics(), 0.8, &random);
    for (double& scale : body_.scales) scale = 0.9 + 0.2 * (random() % 100) / 100;
    for (double& offset : body_.offsets.reshaped()) offset = 0.05 * (random() % 100) / 100;
  }

  /// Marker positions, 3 markers long, for a body.
  Eigen::VectorXd Place(const Body& body) {
    kinematics_.SetBody(body);
    BodyJacobian at = kinematics_.MakeJacobian();
    kinematics_.Compute(posture_, &at);
    return at.posture.p_WM.reshaped();
  }

  KinematicModel model_;
  BodyKinematics kinematics_;
  Body body_;
  Posture posture_;
};

// Central differences over 1e-6 of functions that are linear (offsets, scales): rounding of
// positions of 1 m is left, 1e-16 / 1e-6.
constexpr double kStep = 1e-6;
constexpr double kTolerance = 1e-8;

TEST_F(BodyKinematicsTest, SlopesByScalesAreThoseOfDifferences) {
  kinematics_.SetBody(body_);
  BodyJacobian at = kinematics_.MakeJacobian();
  kinematics_.Compute(posture_, &at);
  for (Eigen::Index i = 0; i < body_.scales.size(); ++i) {
    Body more = body_;
    Body less = body_;
    more.scales[i] += kStep;
    less.scales[i] -= kStep;
    const Eigen::VectorXd slope = (Place(more) - Place(less)) / (2 * kStep);
    EXPECT_LT((slope - at.J_scales.col(i)).cwiseAbs().maxCoeff(), kTolerance)
        << model_.segments()[kinematics_.lengths().segments[i]].name;
  }
}

TEST_F(BodyKinematicsTest, SlopesByOffsetsAreThoseOfDifferences) {
  kinematics_.SetBody(body_);
  BodyJacobian at = kinematics_.MakeJacobian();
  kinematics_.Compute(posture_, &at);
  for (Eigen::Index m = 0; m < body_.offsets.cols(); ++m) {
    for (int i = 0; i < 3; ++i) {
      Body more = body_;
      Body less = body_;
      more.offsets(i, m) += kStep;
      less.offsets(i, m) -= kStep;
      Eigen::VectorXd slope = (Place(more) - Place(less)) / (2 * kStep);
      slope.segment<3>(3 * m) -= at.R_WS[m].col(i);
      EXPECT_LT(slope.cwiseAbs().maxCoeff(), kTolerance) << m;
    }
  }
}

TEST_F(BodyKinematicsTest, TheModelsOwnBodyIsTheModel) {
  const MarkerKinematics plain(model_, kinematics_.joints(), kinematics_.markers());
  MarkerJacobian expected = plain.MakeJacobian();
  plain.ComputeMarkers(posture_.position, posture_.orientation.toRotationMatrix(),
                       posture_.joint_angles, &expected);
  const Eigen::VectorXd placed = Place(kinematics_.ModelBody());
  EXPECT_EQ((placed - expected.p_WM.reshaped()).cwiseAbs().maxCoeff(), 0);
}

}  // namespace
}  // namespace mmm_converter
