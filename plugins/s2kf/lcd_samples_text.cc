// SPDX-License-Identifier: MIT
#include "plugins/s2kf/lcd_samples_text.h"

#include <charconv>
#include <cmath>

namespace mmm_converter::s2kf {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr double kMillionths = 1e6;

std::string Heading(int dimension, int num_samples) {
  return "LCD samples of the standard normal, half of a point-symmetric set, in millionths, before "
         "the covariance map: dimension " +
         std::to_string(dimension) + ", samples " + std::to_string(num_samples) + "\n";
}

}  // namespace

std::string FormatLcdSamples(const MatrixXd& half_samples) {
  std::string text =
      Heading(static_cast<int>(half_samples.rows()), static_cast<int>(2 * half_samples.cols() + 1));
  for (Index k = 0; k < half_samples.cols(); ++k) {
    for (Index i = 0; i < half_samples.rows(); ++i) {
      if (i > 0) text += ' ';
      text += std::to_string(std::lround(half_samples(i, k) * kMillionths));
    }
    text += '\n';
  }
  return text;
}

std::optional<MatrixXd> ParseLcdSamples(std::string_view text, int dimension, int num_samples) {
  if (text.substr(0, text.find('\n') + 1) != Heading(dimension, num_samples)) return std::nullopt;
  text.remove_prefix(text.find('\n') + 1);
  const char* position = text.data();
  const char* const end = text.data() + text.size();
  MatrixXd half_samples(dimension, num_samples / 2);
  for (Index k = 0; k < half_samples.cols(); ++k) {
    for (Index i = 0; i < dimension; ++i) {
      int value = 0;
      const auto [next, error] = std::from_chars(position, end, value);
      const char separator = i + 1 < dimension ? ' ' : '\n';
      if (error != std::errc() || next == end || *next != separator) return std::nullopt;
      half_samples(i, k) = value / kMillionths;
      position = next + 1;
    }
  }
  if (position != end) return std::nullopt;
  return half_samples;
}

// Made from the files in plugins/s2kf/samples by cmake/EmbedFile.cmake.
std::string_view Lcd46Samples301();
std::string_view Lcd46Samples1001();
std::string_view Lcd50Samples301();

std::string_view ShippedLcdSamples(int dimension, int num_samples) {
  if (dimension == 46 && num_samples == 301) return Lcd46Samples301();
  if (dimension == 46 && num_samples == 1001) return Lcd46Samples1001();
  if (dimension == 50 && num_samples == 301) return Lcd50Samples301();
  return {};
}

}  // namespace mmm_converter::s2kf
