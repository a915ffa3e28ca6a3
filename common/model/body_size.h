// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

namespace mmm_converter {

/// What is known of the size of a person.
struct BodySize {
  std::optional<double> height;       ///< [m]
  std::optional<double> mass;         ///< [kg]
  std::optional<double> hand_length;  ///< wrist to finger tip [m]

  bool empty() const { return !height && !mass && !hand_length; }
};

}  // namespace mmm_converter
