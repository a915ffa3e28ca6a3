// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/report/json.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "common/support/error.h"

namespace mmm_converter {
namespace {

constexpr int kDeepest = 100;  // values are destroyed and written by recursion

/// Before parsing: the parser's own callback takes quadratic time.
void CheckDepth(std::string_view text) {
  int depth = 0;
  bool is_in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"') is_in_string = !is_in_string;
    if (is_in_string) {
      if (c == '\\') ++i;
      continue;
    }
    if (c == '[' || c == '{') ++depth;
    if (c == ']' || c == '}') --depth;
    if (depth > kDeepest) throw Error(fmt::format("is nested more than {} deep", kDeepest));
  }
}

}  // namespace

Json Number(double value, int decimals) {
  if (!std::isfinite(value)) return nullptr;
  const double unit = std::pow(10, decimals);
  return std::round(value * unit) / unit;
}

Json TextOrNull(const std::string& text) { return text.empty() ? Json(nullptr) : Json(text); }

Json ParseJson(std::string_view text) {
  CheckDepth(text);
  try {
    return Json::parse(text);
  } catch (const nlohmann::json::parse_error& error) {
    throw Error(fmt::format("is not JSON: byte {} can't be understood", error.byte));
  } catch (const nlohmann::json::out_of_range&) {
    throw Error("is not JSON: a number is too large");
  }
}

std::int64_t ParseInteger(const Json& json, std::int64_t lowest, std::int64_t largest) {
  // What has a point or does not fit into 64 bits is a double, which may be no std::int64_t.
  const bool fits =
      json.is_number_unsigned() ? json.get<std::uint64_t>() <= INT64_MAX : json.is_number_integer();
  const std::int64_t value = fits ? json.get<std::int64_t>() : 0;
  if (!fits || value < lowest || value > largest) {
    throw Error(
        fmt::format("{} is no whole number from {} to {}", FormatJsonLine(json), lowest, largest));
  }
  return value;
}

std::string FormatJson(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string FormatJsonLine(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace mmm_converter
