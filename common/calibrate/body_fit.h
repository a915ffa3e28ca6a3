// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/calibrate/body_kinematics.h"
#include "common/calibrate/calibration.h"
#include "common/calibrate/calibration_frames.h"

namespace mmm_converter {

struct BodyFitResult {
  double cost = 0;  ///< -2 log of the posterior density, but for a constant
  int iterations = 0;
  bool converged = false;
  Body deviations;  ///< standard deviations of the body, postures being unknown too
  /// The body's covariance, as BodyEquations order it, and how the joints' angles follow the body
  /// on average over the frames, joints x body.
  Eigen::MatrixXd covariance, joint_slopes;
  double side_correlation = 0;             ///< OffsetPrior::LikelyCorrelation
  Eigen::VectorXd prior_scale_deviations;  ///< of the scales before any recording
  /// What all scales have in common beyond 1, and its standard deviation, where the height is a
  /// guess; else 0.
  double common_scale = 0, common_deviation = 0;
};

/// Of each used marker's place before any recording is seen [m].
Eigen::VectorXd PlaceDeviations(const CalibrationOptions& options,
                                const Eigen::VectorXd& noise_scale);

/// The body and all postures together, as their most likely values where a marker is where its
/// segment has it but for its skin's movement (Cauchy, heavier tails than normal), with the priors
/// of the options and joint angles inside their limits. Levenberg-Marquardt; each step eliminates
/// the postures first (Schur complement), so that its cost grows with the number of frames only.
/// noise_scale: by used marker, a factor on skin_deviation and, of places_by_noise, on
/// marker_deviation. frames and body: start and result.
BodyFitResult FitBody(BodyKinematics* kinematics, const CalibrationOptions& options,
                      const Eigen::VectorXd& noise_scale, std::vector<CalibrationFrame>* frames,
                      Body* body);

}  // namespace mmm_converter
