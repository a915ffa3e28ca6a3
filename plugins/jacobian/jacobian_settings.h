// SPDX-License-Identifier: MIT
#pragma once

#include "common/convert/converter_config.h"
#include "common/convert/settings.h"

namespace mmm_converter::jacobian {

enum class Method {
  kLeastSquares,  ///< Levenberg-Marquardt to convergence
  kGradient,      ///< a fixed number of damped, limited Jacobian steps
};

/// All that a configuration can say to the JacobianConverter, at its defaults. SI units.
struct JacobianSettings {
  Method method = Method::kLeastSquares;
  double robust_distance = 0;     ///< [m]; 0: all markers count in full
  double natural_weight = 0.003;  ///< [m/rad]
  int start_attempts = 32;

  int max_iterations = 50;
  double tolerance = 1e-6;
  double previous_weight = 0;  ///< [m/rad]

  int steps = 2;
  double damping = 0.1;      ///< [m/rad]
  double step_limit = 0.02;  ///< [rad]
};

/// The settings of `values` as attributes of a configuration. `values` must outlive the table.
SettingTable BindSettings(JacobianSettings* values);

/// @throws Error with all that is wrong in the configuration's plugin elements (file and line).
JacobianSettings ReadSettings(const ConverterConfig& config);

}  // namespace mmm_converter::jacobian
