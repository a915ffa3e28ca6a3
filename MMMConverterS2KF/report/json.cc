// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/report/json.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "common/support/error.h"

namespace mmm_converter {
namespace {

constexpr int kDeepest = 100;  // values are destroyed and written by recursion

}  // namespace

Json Number(double value, int decimals) {
  if (!std::isfinite(value)) return nullptr;
  const double unit = std::pow(10, decimals);
  return std::round(value * unit) / unit;
}

Json TextOrNull(const std::string& text) { return text.empty() ? Json(nullptr) : Json(text); }

Json ParseJson(std::string_view text) {
  const auto check = [](int depth, Json::parse_event_t, Json&) {
    if (depth <= kDeepest) return true;
    throw Error(fmt::format("is nested more than {} deep", kDeepest));
  };
  try {
    return Json::parse(text, check);
  } catch (const nlohmann::json::parse_error& error) {
    throw Error(fmt::format("is not JSON: byte {} can't be understood", error.byte));
  }
}

std::string FormatJson(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string FormatJsonLine(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace mmm_converter
