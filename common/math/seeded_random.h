// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <random>

namespace mmm_converter {

/// Random numbers that depend on the seed only: the distributions of the standard library differ
/// from one library to the next, its engine does not.
class SeededRandom {
 public:
  explicit SeededRandom(std::uint64_t seed) : engine_(seed) {}

  double Uniform();             ///< in [0, 1)
  int UniformIndex(int count);  ///< in [0, count), count > 0
  double Normal();              ///< mean 0, standard deviation 1 (Marsaglia's polar method)
  int Poisson(double mean);     ///< mean in [0, 700]

 private:
  std::mt19937_64 engine_;
  double spare_normal_ = 0;
  bool has_spare_normal_ = false;
};

/// Draws an index with a probability proportional to its weight: the one at which the sum of the
/// weights so far reaches this share, in [0, 1), of all. weights: at least one, none negative.
int IndexAtShare(double share, const Eigen::Ref<const Eigen::VectorXd>& weights);

}  // namespace mmm_converter
