// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/report/packed_array.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>

namespace mmm_converter {
namespace {

constexpr int kLargestRaw = 65534;
constexpr std::uint16_t kNotANumber = 65535;

template <typename Unsigned>
void AppendLittleEndian(Unsigned number, std::string* bytes) {
  for (std::size_t i = 0; i < sizeof(number); ++i) {
    bytes->push_back(static_cast<char>((number >> (8 * i)) & 0xff));
  }
}

}  // namespace

Json ToJson(const PackedArray& packed) {
  return {{"type", packed.type},
          {"scale", packed.scale},
          {"offset", packed.offset},
          {"base64", packed.base64}};
}

PackedArray PackFloats(const Eigen::Ref<const Eigen::MatrixXd>& numbers) {
  std::string bytes;
  bytes.reserve(numbers.size() * sizeof(float));
  for (const auto& column : numbers.colwise()) {
    for (const double number : column) {
      AppendLittleEndian(std::bit_cast<std::uint32_t>(static_cast<float>(number)), &bytes);
    }
  }
  return {"f32", 1, 0, EncodeBase64(bytes)};
}

PackedArray PackQuantised(const Eigen::Ref<const Eigen::MatrixXd>& numbers) {
  double least = std::numeric_limits<double>::infinity();
  double most = -least;
  for (const auto& column : numbers.colwise()) {
    for (const double number : column) {
      if (!std::isfinite(number)) continue;
      least = std::min(least, number);
      most = std::max(most, number);
    }
  }
  if (least > most) least = most = 0;
  const double scale = most > least ? (most - least) / kLargestRaw : 1;
  std::string bytes;
  bytes.reserve(numbers.size() * sizeof(std::uint16_t));
  for (const auto& column : numbers.colwise()) {
    for (const double number : column) {
      const auto raw = std::isfinite(number)
                           ? static_cast<std::uint16_t>(std::lround((number - least) / scale))
                           : kNotANumber;
      AppendLittleEndian(raw, &bytes);
    }
  }
  return {"u16", scale, least, EncodeBase64(bytes)};
}

PackedArray PackBits(
    const Eigen::Ref<const Eigen::Matrix<bool, Eigen::Dynamic, Eigen::Dynamic>>& bits) {
  std::string bytes((bits.size() + 7) / 8, '\0');
  std::size_t place = 0;
  for (const auto& column : bits.colwise()) {
    for (const bool bit : column) {
      if (bit) bytes[place / 8] = static_cast<char>(bytes[place / 8] | (1 << (place % 8)));
      ++place;
    }
  }
  return {"bits", 1, 0, EncodeBase64(bytes)};
}

std::string EncodeBase64(std::string_view bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t j = 0; j < 3; ++j) {
      group = group << 8 | (j < count ? static_cast<std::uint8_t>(bytes[i + j]) : 0);
    }
    for (std::size_t j = 0; j < 4; ++j) {
      text.push_back(j <= count ? kDigits[group >> (18 - 6 * j) & 63] : '=');
    }
  }
  return text;
}

}  // namespace mmm_converter
