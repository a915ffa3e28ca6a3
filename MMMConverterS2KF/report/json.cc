// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/report/json.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace mmm_converter {

Json Number(double value, int decimals) {
  if (!std::isfinite(value)) return nullptr;
  const double unit = std::pow(10, decimals);
  return std::round(value * unit) / unit;
}

Json TextOrNull(const std::string& text) { return text.empty() ? Json(nullptr) : Json(text); }

std::string FormatJson(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string FormatJsonLine(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace mmm_converter
