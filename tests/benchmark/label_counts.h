// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace mmm_converter {

/// Of points.
struct Counts {
  double right = 0, wrong = 0, left = 0, ghosts = 0;
  double changed = 0;  // right ones that a repair changes
  double frames = 0, seconds = 0;
  std::map<std::pair<int, int>, int> confusions;  // label that is right, label given; -1: none

  void Count(int truth, int given) {
    if (truth < 0 && given < 0) return;
    (truth < 0 ? ghosts : given == truth ? right : given < 0 ? left : wrong) += 1;
    if (given != truth) ++confusions[{truth, given}];
  }
  double markers() const { return right + wrong + left; }
};

/// A line for each name: shares of all its runs, time a frame; then their mean and the worst run.
void PrintCounts(const std::map<std::string, std::vector<Counts>>& all);

}  // namespace mmm_converter
