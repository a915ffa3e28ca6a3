// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

namespace mmm_converter {

/// A table of OpenSim (.mot, .sto): what is said before "endheader", then names, then numbers.
struct StorageTable {
  std::vector<std::string> columns;  ///< the first is "time"
  Eigen::MatrixXd rows;              ///< a row for each time; NaN where there is no number
};

/// `file` is only named in messages.
/// @throws Error where there is no "endheader", no column "time", no row, or a row has another
///         number of cells than there are columns.
StorageTable ParseStorage(std::string_view content, const std::string& file);

}  // namespace mmm_converter
