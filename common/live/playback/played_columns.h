// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace mmm_converter {

/// What the columns of a recording that is played are. Points without a label are called `*` and a
/// number, as ReadRecording does.
struct PlayedColumns {
  explicit PlayedColumns(const std::vector<std::string>& labels);

  std::vector<Eigen::Index> labelled, unlabelled;  ///< columns
  std::vector<std::string> labels;                 ///< of the labelled ones
};

}  // namespace mmm_converter
