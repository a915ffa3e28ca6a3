// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/math/up_axis.h"

namespace mmm_converter {

/// What GetParameters answers of the whole system and of its labelled points.
struct QtmParameters {
  double rate = 0;          ///< [Hz]; 0: not said
  double capture_time = 0;  ///< [s]
  bool has_3d = false;      ///< what follows is there
  UpAxis up_axis = UpAxis::kZ;
  std::optional<std::string> calibration_time;  ///< empty: not calibrated; nothing: not said
  std::vector<std::string> labels;              ///< in the order of the data
};

/// @throws Error where this is no such XML, or not as it should be.
QtmParameters ParseQtmParameters(std::string_view xml);

/// Which parameters are asked for.
struct QtmParameterChoice {
  bool general = false, the_3d = false, the_6d = false, analog = false, force = false;
  bool gaze_vector = false, eye_tracker = false, image = false, skeleton = false;
};

/// The answer in version 1.minor. What QtmParameters knows nothing of is empty.
std::string FormatQtmParameters(const QtmParameters& parameters, const QtmParameterChoice& choice,
                                int minor);

}  // namespace mmm_converter
