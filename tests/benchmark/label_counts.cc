// SPDX-License-Identifier: MIT
#include "tests/benchmark/label_counts.h"

#include <algorithm>
#include <cstdio>

#include "common/support/units.h"

namespace mmm_converter {

void PrintCounts(const std::map<std::string, std::vector<Counts>>& all) {
  Counts mean;  // of the recordings' shares
  double worst = 1;
  std::printf("%-8s %7s %7s %7s %7s  ms/frame\n", "", "right", "wrong", "left", "ghosts");
  const auto print = [](const std::string& name, const Counts& c) {
    std::printf("%-8s %7.2f %7.2f %7.2f %7.2f  %.2f\n", name.c_str(),
                kPercent * c.right / c.markers(), kPercent * c.wrong / c.markers(),
                kPercent * c.left / c.markers(), kPercent * c.ghosts / c.markers(),
                kMilliseconds * c.seconds / c.frames);
  };
  for (const auto& [name, runs] : all) {
    Counts sum;
    for (const Counts& c : runs) {
      sum.right += c.right;
      sum.wrong += c.wrong;
      sum.left += c.left;
      sum.ghosts += c.ghosts;
      sum.frames += c.frames;
      sum.seconds += c.seconds;
      worst = std::min(worst, c.right / c.markers());
    }
    print(name, sum);
    const double n = sum.markers();
    mean.right += sum.right / n;
    mean.wrong += sum.wrong / n;
    mean.left += sum.left / n;
    mean.ghosts += sum.ghosts / n;
    mean.frames += sum.frames;
    mean.seconds += sum.seconds;
  }
  print("mean", mean);
  std::printf("worst    %7.2f\n", kPercent * worst);
}

}  // namespace mmm_converter
