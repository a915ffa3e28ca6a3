// SPDX-License-Identifier: MIT
#include "common/math/seeded_random.h"

#include <cassert>
#include <cmath>

namespace mmm_converter {

double SeededRandom::Uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

int SeededRandom::UniformIndex(int count) {
  assert(count > 0);
  return static_cast<int>(Uniform() * count);
}

double SeededRandom::Normal() {
  if (has_spare_normal_) {
    has_spare_normal_ = false;
    return spare_normal_;
  }
  double x = 0;
  double y = 0;
  double squared = 0;
  do {
    x = 2 * Uniform() - 1;
    y = 2 * Uniform() - 1;
    squared = x * x + y * y;
  } while (squared >= 1 || squared == 0);
  const double scale = std::sqrt(-2 * std::log(squared) / squared);
  spare_normal_ = y * scale;
  has_spare_normal_ = true;
  return x * scale;
}

int SeededRandom::Poisson(double mean) {
  assert(mean >= 0 && mean <= 700);  // beyond, exp(-mean) underflows
  const double limit = std::exp(-mean);
  double product = Uniform();
  int count = 0;
  while (product > limit) {
    product *= Uniform();
    ++count;
  }
  return count;
}

int IndexAtShare(double share, const Eigen::Ref<const Eigen::VectorXd>& weights) {
  double left = share * weights.sum();
  int index = 0;
  while (index + 1 < weights.size() && (left -= weights[index]) > 0) ++index;
  return index;
}

}  // namespace mmm_converter
