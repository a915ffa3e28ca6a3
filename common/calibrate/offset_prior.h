// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/calibrate/body_kinematics.h"
#include "common/calibrate/calibration.h"
#include "common/calibrate/frame_equations.h"

namespace mmm_converter {

/// Where markers are worn before any recording is seen: about the model's places, by
/// a deviation of each, nearer them across a pair's line; as far off on one side of the body as on
/// the other by side_correlation, as whoever placed the model's markers placed both alike. Tails
/// are Cauchy's, as some are worn far off.
class OffsetPrior {
 public:
  /// deviations: of each used marker's place [m].
  OffsetPrior(const BodyKinematics& kinematics, const CalibrationOptions& options,
              const Eigen::VectorXd& deviations);

  /// -2 log of the density, but for a constant. offsets: 3 x used markers [m].
  double Cost(const Eigen::Matrix3Xd& offsets) const;
  /// Adds what it says of a step from there.
  void Add(const Eigen::Matrix3Xd& offsets, BodyEquations* body) const;

  /// The side_correlation that offsets and their covariance make most likely (Dempster et al.
  /// 1977). covariance: of the body, as BodyEquations order it.
  double LikelyCorrelation(const Eigen::Matrix3Xd& offsets,
                           const Eigen::MatrixXd& covariance) const;

 private:
  // A o_a + B o_b has three coordinates of variance 1.
  struct Term {
    Eigen::Index a, b;  // b < 0: of one marker alone
    Eigen::Matrix3d A, B;

    Eigen::Vector3d Of(const Eigen::Matrix3Xd& offsets) const;
  };
  struct Mirrored {
    Eigen::Index a, b;
    Eigen::Matrix3d A, B;  // A o_a and B o_b: in the same axes, each of variance 1
  };

  double correlation_;
  std::vector<Mirrored> mirrored_;
  std::vector<Term> terms_;
};

}  // namespace mmm_converter
