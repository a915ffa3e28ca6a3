// SPDX-License-Identifier: MIT
#include "plugins/s2kf/joint_limit_transform.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace mmm_converter::s2kf {

namespace {
// sin: slope cos(Theta) = 0.05; tanh: slope 1 - f^2 = 0.05.
constexpr double kLargestSine = 0.99875;
constexpr double kLargestTanh = 0.974679;
constexpr double kPi = std::numbers::pi;
}  // namespace

JointLimitTransform::JointLimitTransform(LimitFunction function, const Eigen::VectorXd& lower,
                                         const Eigen::VectorXd& upper)
    : function_(function),
      is_linear_(lower.array().isInf() && upper.array().isInf()),
      half_range_(is_linear_.select(2 * kPi, 0.5 * (upper - lower))),
      middle_(is_linear_.select(0, 0.5 * (upper + lower))) {}

JointLimitTransform::JointLimitTransform(LimitFunction function, const MarkerKinematics& kinematics)
    : JointLimitTransform(function, kinematics.lower(), kinematics.upper()) {
  for (int j = 0; j < kinematics.num_joints(); ++j) {
    if (!is_linear_[j] || kinematics.IsEndless(j)) continue;
    const auto [lower, upper] = kinematics.Range(j);
    half_range_[j] = 0.5 * (upper - lower);
    middle_[j] = 0.5 * (lower + upper);
  }
}

double JointLimitTransform::Angle(int joint, double parameter) const {
  if (is_linear_[joint]) return half_range_[joint] * parameter + middle_[joint];
  const double f = function_ == LimitFunction::kSine ? std::sin(parameter) : std::tanh(parameter);
  return half_range_[joint] * f + middle_[joint];
}

double JointLimitTransform::Slope(int joint, double parameter) const {
  if (is_linear_[joint]) return half_range_[joint];
  if (function_ == LimitFunction::kSine) return half_range_[joint] * std::cos(parameter);
  const double f = std::tanh(parameter);
  return half_range_[joint] * (1 - f * f);
}

double JointLimitTransform::Parameter(int joint, double angle) const {
  const double f = (angle - middle_[joint]) / half_range_[joint];
  if (is_linear_[joint]) return f;
  if (function_ == LimitFunction::kSine)
    return std::asin(std::clamp(f, -kLargestSine, kLargestSine));
  return std::atanh(std::clamp(f, -kLargestTanh, kLargestTanh));
}

double JointLimitTransform::AngleDeviation(int joint, double mean, double deviation) const {
  if (is_linear_[joint] || function_ == LimitFunction::kTanh) {
    return std::abs(Slope(joint, mean)) * deviation;
  }
  // X ~ N(m, v): Var[sin X] = d (2 - d)/2 - d (1 - d) sin^2 m with d = 1 - e^-v.
  const double d = -std::expm1(-deviation * deviation);
  const double sine = std::sin(mean);
  const double variance = d * (0.5 * (2 - d) - (1 - d) * sine * sine);
  return half_range_[joint] * std::sqrt(std::max(variance, 0.0));
}

bool JointLimitTransform::Fold(int joint, double* parameter) const {
  if (is_linear_[joint] || function_ != LimitFunction::kSine || std::abs(*parameter) <= kPi / 2)
    return false;
  *parameter = std::remainder(*parameter, 2 * kPi);
  if (std::abs(*parameter) <= kPi / 2) return false;
  *parameter = (*parameter > 0 ? kPi : -kPi) - *parameter;
  return true;
}

}  // namespace mmm_converter::s2kf
