// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>

namespace mmm_converter::s2kf {

/// How sample sets are shipped and cached: a heading, then one sample a line as whole millionths,
/// so that a set is the same bytes wherever it comes from. half_samples: n x K multiples of 1e-6.
std::string FormatLcdSamples(const Eigen::MatrixXd& half_samples);

/// Nothing where the text is not such a set of this dimension and number of samples 2K + 1.
std::optional<Eigen::MatrixXd> ParseLcdSamples(std::string_view text, int dimension,
                                               int num_samples);

/// The text of a shipped set; empty where there is none.
std::string_view ShippedLcdSamples(int dimension, int num_samples);

}  // namespace mmm_converter::s2kf
