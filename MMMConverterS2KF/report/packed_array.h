// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>

#include "MMMConverterS2KF/report/json.h"

namespace mmm_converter {

/// Numbers as the page reads them: base64 of little-endian values, column by column.
struct PackedArray {
  std::string type;  ///< f32; u16: number = raw * scale + offset, 65535 is NaN; bits: lowest first
  double scale = 1;
  double offset = 0;
  std::string base64;
};

/// As packed.js takes it.
Json ToJson(const PackedArray& packed);

PackedArray PackFloats(const Eigen::Ref<const Eigen::MatrixXd>& numbers);

/// Steps of 1/65534 of the range of the finite numbers.
PackedArray PackQuantised(const Eigen::Ref<const Eigen::MatrixXd>& numbers);

PackedArray PackBits(
    const Eigen::Ref<const Eigen::Matrix<bool, Eigen::Dynamic, Eigen::Dynamic>>& bits);

std::string EncodeBase64(std::string_view bytes);

}  // namespace mmm_converter
