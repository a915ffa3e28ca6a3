// SPDX-License-Identifier: MIT
#pragma once

#include "common/convert/converter_config.h"
#include "common/convert/settings.h"
#include "plugins/s2kf/belief.h"
#include "plugins/s2kf/gaussian_update.h"
#include "plugins/s2kf/joint_limit_transform.h"
#include "plugins/s2kf/motion_model.h"

namespace mmm_converter::s2kf {

enum class FilterType {
  kS2kf,  ///< LCD samples [S13]
  kUkf,   ///< 2n + 1 sigma points in a random rotation
  kEkf,   ///< analytic Jacobian
};

enum class MotionModelType {
  kAuto,  ///< a velocity where markers are trusted more than the usual ones, else a random walk
  kRandomWalk,
  kVelocity
};

enum class StartMethod {
  kFit,    ///< rigid fit, Levenberg-Marquardt, random restarts
  kPaper,  ///< root at the mean of the markers, everything else 0 [S15]
};

/// What standard deviations are made of beyond what the recording's residuals tell.
struct DeviationSettings {
  double marker_offset = 0.028;  ///< of a marker from the model's place [m], each coordinate
  double length_share = 0.33;    ///< variance by lengths over that which residuals show
  double limb_speed = 0.7;       ///< of a hidden marker [m/s]
};

/// All that a configuration can say to the S2KFConverter, at its defaults. SI units.
struct S2kfSettings {
  FilterType filter = FilterType::kS2kf;
  int samples = 301;
  UpdateForm update = UpdateForm::kRegression;
  int iterations = 3;
  RootParameters root = RootParameters::kSo3;
  LimitFunction limits = LimitFunction::kSine;

  MotionModelType motion_model = MotionModelType::kAuto;
  ProcessNoise noise = {0.3, 0.3, 0.17};
  double natural_spread = 0.15;
  double velocity_decay = 0.2;
  ProcessNoise velocity_noise = {1.0, 3.0, 3.0};
  double process_noise_scale = 1;  ///< on the variances of noise and velocity_noise
  bool choose_process_noise_scale = false;

  double marker_deviation = 0.005;
  double robust_distance = 0.1;
  double gate_probability = 1e-6;
  DeviationSettings deviations;

  StartMethod start = StartMethod::kFit;
  int start_attempts = 32;
  bool recovery = true;

  bool smoothing = false;
  bool learn_places = false;
  /// Beliefs are kept for so many frames at a time (with rates 68 kB each), and of the frames
  /// before every so manieth. Not in the configuration: the result does not depend on it.
  int smoothing_chunk = 1000;
};

/// The settings of `values` as attributes of a configuration. `values` must outlive the table.
SettingTable BindSettings(S2kfSettings* values);

/// @throws Error with all that is wrong in the configuration's plugin elements (file and line).
S2kfSettings ReadSettings(const ConverterConfig& config);

}  // namespace mmm_converter::s2kf
