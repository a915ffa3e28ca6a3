// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/math/padded_matrix.h"

namespace mmm_converter {

/// Normal equations of a trajectory: a symmetric positive matrix of blocks, a row of blocks a
/// frame, in which a frame is coupled to the two before it by diagonal blocks alone (differences
/// over time of each quantity).
struct BlockBand {
  std::vector<Eigen::MatrixXd> diagonal;  ///< of each frame; the lower half counts
  std::vector<Eigen::VectorXd> before;    ///< with the frame before it; the first has none
  std::vector<Eigen::VectorXd> before2;   ///< with the second before it
  std::vector<Eigen::VectorXd> right;     ///< the right-hand side
  // Scratch: the factor's blocks.
  std::vector<PaddedMatrix> factor, factor_before, factor_before2;
  PaddedMatrix column;

  void Resize(int frames, int size);
  void SetZero();
  int num_frames() const { return static_cast<int>(diagonal.size()); }
};

/// The solution in band->right, by a Cholesky factor; linear in the number of frames. False: the
/// matrix is not positive.
bool SolveInPlace(BlockBand* band);

}  // namespace mmm_converter
