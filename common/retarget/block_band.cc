// SPDX-License-Identifier: MIT
#include "common/retarget/block_band.h"

#include "common/math/dense.h"

namespace mmm_converter {

void BlockBand::Resize(int frames, int size) {
  const auto blocks = static_cast<std::size_t>(frames);
  diagonal.resize(blocks);
  for (Eigen::MatrixXd& block : diagonal) block.resize(size, size);
  for (auto* list : {&before, &before2, &right}) {
    list->resize(blocks);
    for (Eigen::VectorXd& block : *list) block.resize(size);
  }
  for (auto* list : {&factor, &factor_before, &factor_before2}) {
    list->assign(blocks, PaddedMatrix(size, size));
  }
  column = PaddedMatrix(size, 1);
}

void BlockBand::SetZero() {
  for (Eigen::MatrixXd& block : diagonal) block.setZero();
  for (auto* list : {&before, &before2, &right}) {
    for (Eigen::VectorXd& block : *list) block.setZero();
  }
}

bool SolveInPlace(BlockBand* band) {
  const int frames = band->num_frames();
  band->column.SetZero();
  auto x = band->column.view().col(0);
  for (int k = 0; k < frames; ++k) {
    PaddedMatrix& G = band->factor[k];
    PaddedMatrix& G1 = band->factor_before[k];
    PaddedMatrix& G2 = band->factor_before2[k];
    G.SetZero();
    G.view() = band->diagonal[k];
    x = band->right[k];
    if (k >= 2) {
      G2.SetZero();
      G2.view() = band->before2[k].asDiagonal();
      DivideByTransposed(band->factor[k - 2], &G2);
      AddSquare(-1, G2, &G);
      x.noalias() -= G2.view() * band->right[k - 2];
    }
    if (k >= 1) {
      G1.SetZero();
      if (k >= 2) MultiplyByTransposed(G2, band->factor_before[k - 1], &G1);
      G1.view() = -G1.view();
      G1.view().diagonal() += band->before[k];
      DivideByTransposed(band->factor[k - 1], &G1);
      AddSquare(-1, G1, &G);
      x.noalias() -= G1.view() * band->right[k - 1];
    }
    Factorize(&G);
    if (!(G.view().diagonal().minCoeff() > 0)) return false;
    SolveLower(G, &band->column);
    band->right[k] = x;
  }
  for (int k = frames - 1; k >= 0; --k) {
    x = band->right[k];
    if (k + 1 < frames)
      x.noalias() -= band->factor_before[k + 1].view().transpose() * band->right[k + 1];
    if (k + 2 < frames)
      x.noalias() -= band->factor_before2[k + 2].view().transpose() * band->right[k + 2];
    SolveLowerTransposed(band->factor[k], &band->column);
    band->right[k] = x;
  }
  return true;
}

}  // namespace mmm_converter
