// SPDX-License-Identifier: MIT
#pragma once

namespace mmm_converter {

inline double Square(double x) { return x * x; }

}  // namespace mmm_converter
