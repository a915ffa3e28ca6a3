// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace mmm_converter {

/// By which squared distances from aims are multiplied.
struct AimWeights {
  double feet = 1, hands = 1;
  double trunk = 1;  ///< pelvis and chest
  double limbs = 1;  ///< directions of thighs, shanks, upper arms and forearms
};

/// "feet=2,hands=0.5"; what is not named stays 1. @throws Error where that is no weight.
AimWeights ParseAimWeights(const std::string& text);

/// Of a file with one of them a line, behind # what is not read. @throws Error with file and line.
AimWeights ParseAimWeightLines(const std::string& content, const std::string& file);

/// The deviation of an aim so weighed.
double Weighed(double deviation, double weight);

}  // namespace mmm_converter
