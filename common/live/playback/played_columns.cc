// SPDX-License-Identifier: MIT
#include "common/live/playback/played_columns.h"

namespace mmm_converter {

PlayedColumns::PlayedColumns(const std::vector<std::string>& all) {
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    if (all[i].starts_with('*')) {
      unlabelled.push_back(column);
    } else {
      labelled.push_back(column);
      labels.push_back(all[i]);
    }
  }
}

}  // namespace mmm_converter
