// SPDX-License-Identifier: MIT
#include "common/retarget/block_band.h"

#include <Eigen/Cholesky>

namespace mmm_converter {

void BlockBand::Resize(int frames, int size) {
  const auto blocks = static_cast<std::size_t>(frames);
  for (auto* list : {&diagonal, &factor_before, &factor_before2}) {
    list->resize(blocks);
    for (Eigen::MatrixXd& block : *list) block.resize(size, size);
  }
  for (auto* list : {&before, &before2, &right}) {
    list->resize(blocks);
    for (Eigen::VectorXd& block : *list) block.resize(size);
  }
}

void BlockBand::SetZero() {
  for (Eigen::MatrixXd& block : diagonal) block.setZero();
  for (auto* list : {&before, &before2, &right}) {
    for (Eigen::VectorXd& block : *list) block.setZero();
  }
}

bool SolveInPlace(BlockBand* band) {
  const int frames = band->num_frames();
  for (int k = 0; k < frames; ++k) {
    Eigen::MatrixXd& D = band->diagonal[k];
    Eigen::VectorXd& b = band->right[k];
    Eigen::MatrixXd& B1 = band->factor_before[k];
    Eigen::MatrixXd& B2 = band->factor_before2[k];
    // Blocks to the left, transposed: rows of the frames before.
    if (k >= 2) {
      B2 = band->before2[k].asDiagonal();
      band->diagonal[k - 2].triangularView<Eigen::Lower>().solveInPlace(B2);
      D.selfadjointView<Eigen::Lower>().rankUpdate(B2.transpose(), -1);
      b.noalias() -= B2.transpose() * band->right[k - 2];
    }
    if (k >= 1) {
      B1 = band->before[k].asDiagonal();
      if (k >= 2) B1.noalias() -= band->factor_before[k - 1].transpose() * B2;
      band->diagonal[k - 1].triangularView<Eigen::Lower>().solveInPlace(B1);
      D.selfadjointView<Eigen::Lower>().rankUpdate(B1.transpose(), -1);
      b.noalias() -= B1.transpose() * band->right[k - 1];
    }
    Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>, Eigen::Lower> factor(D);
    if (factor.info() != Eigen::Success) return false;
    D.triangularView<Eigen::Lower>().solveInPlace(b);
  }
  for (int k = frames - 1; k >= 0; --k) {
    Eigen::VectorXd& b = band->right[k];
    if (k + 1 < frames) b.noalias() -= band->factor_before[k + 1] * band->right[k + 1];
    if (k + 2 < frames) b.noalias() -= band->factor_before2[k + 2] * band->right[k + 2];
    band->diagonal[k].triangularView<Eigen::Lower>().transpose().solveInPlace(b);
  }
  return true;
}

}  // namespace mmm_converter
