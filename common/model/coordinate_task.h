// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

namespace mmm_converter {

/// A coordinate of a model that is drawn to a value beside what markers say.
struct CoordinateTask {
  std::string name;
  double weight = 1;            ///< [m^2/rad^2], or 1 for a shift
  std::optional<double> value;  ///< [rad, m]; nothing: the default of the model
};

}  // namespace mmm_converter
