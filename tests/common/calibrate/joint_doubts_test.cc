// SPDX-License-Identifier: MIT
#include "common/calibrate/joint_doubts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "common/calibrate/calibration.h"
#include "common/support/units.h"
#include "tests/support/all_indices.h"
#include "tests/support/synthetic_person.h"

namespace mmm_converter {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;

/// Two joints that follow two markers' offsets by given slopes.
class JointDoubts : public ::testing::Test {
 protected:
  JointDoubts()
      : model_(testing::ScaledReferenceModel(1.7)),
        kinematics_(model_, {0, 1}, {MarkerIx(0), MarkerIx(1)}) {
    const Eigen::Index size = 6 + std::ssize(kinematics_.lengths().segments);
    fit_.covariance = 1e-4 * Eigen::MatrixXd::Identity(size, size);  // 10 mm
    fit_.joint_slopes.setZero(2, size);
  }

  KinematicModel model_;
  BodyKinematics kinematics_;
  BodyFitResult fit_;
};

TEST_F(JointDoubts, AreThoseOfTheBodyByTheSlopes) {
  fit_.joint_slopes(0, 1) = 6;    // [rad/m]
  fit_.joint_slopes(0, 4) = 8;    // the other marker
  fit_.joint_slopes(1, 0) = 0.5;  // 0.3 degrees
  const std::vector<JointDoubt> doubts = FindJointDoubts(kinematics_, fit_);
  ASSERT_EQ(doubts.size(), 1);
  EXPECT_EQ(doubts[0].joint, model_.joint(0).name);
  EXPECT_NEAR(doubts[0].deviation, 0.1, 1e-12);
  // It explains 0.64 of the variance, the first 0.36.
  EXPECT_THAT(doubts[0].partners, ElementsAre(model_.markers()[1].name));
}

TEST_F(JointDoubts, NameAllThatErrsTogether) {
  fit_.joint_slopes(0, 1) = 10;
  fit_.covariance(1, 4) = fit_.covariance(4, 1) = 0.9e-4;
  const std::vector<JointDoubt> doubts = FindJointDoubts(kinematics_, fit_);
  ASSERT_EQ(doubts.size(), 1);
  EXPECT_THAT(doubts[0].partners, ElementsAre(model_.markers()[0].name, model_.markers()[1].name));
  EXPECT_THAT(DescribeDoubts(doubts),
              Contains(::testing::HasSubstr("6° (with " + model_.markers()[0].name)));
}

TEST(WidenDeviations, RaisesWhatIsLessThanTheBodyAllows) {
  Subject subject;
  subject.joints = {{"knee", 0.1, {}}, {"not tracked", 1, {}}};
  ConversionResult result;
  result.trajectory.joint_names = {"hip", "knee"};
  result.trajectory.standard_deviations.setConstant(8, 3, 0.05);
  result.trajectory.standard_deviations(7, 1) = 0.3;
  result.trajectory.standard_deviations(7, 2) = kNaN;
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Identity(8, 8) * 0.0025;
  covariance(6, 7) = covariance(7, 6) = 0.001;
  result.covariances = {{0, covariance}};
  WidenDeviations(subject, &result);
  const Eigen::MatrixXd& deviations = result.trajectory.standard_deviations;
  EXPECT_DOUBLE_EQ(deviations(7, 0), 0.1);
  EXPECT_DOUBLE_EQ(deviations(7, 1), 0.3);
  EXPECT_TRUE(std::isnan(deviations(7, 2)));
  EXPECT_EQ((deviations.topRows(7).array() - 0.05).abs().maxCoeff(), 0);
  EXPECT_DOUBLE_EQ(result.covariances[0].covariance(7, 7), 0.01);
  EXPECT_DOUBLE_EQ(result.covariances[0].covariance(6, 7), 0.002) << "the correlation stays";
}

}  // namespace
}  // namespace mmm_converter
