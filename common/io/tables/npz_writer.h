// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/support/text_pieces.h"

namespace mmm_converter {

/// An array of a .npz file, in C order (the last index runs fastest): numbers, texts or integers.
struct NpyArray {
  std::string name;
  std::vector<std::int64_t> shape;  ///< {}: one value
  std::vector<double> numbers;      ///< little-endian float64 in the file
  std::vector<std::string> texts;  ///< in UTF-8, instead of numbers; fixed-width UTF-32 in the file
  std::vector<std::int64_t> integers = {};  ///< instead of numbers; little-endian int64 in the file
};

/// A .npy file, version 1.0, as numpy.lib.format describes it.
std::string FormatNpy(const NpyArray& array);

/// The arrays as a .npz file, which numpy.load opens: a ZIP archive of stored .npy files, without a
/// date (1980-01-01), so that the same arrays give the same bytes. The arrays must outlive the
/// text.
/// @throws Error where the archive would have 4 GiB or more.
TextPieces FormatNpz(const std::vector<NpyArray>& arrays);

}  // namespace mmm_converter
