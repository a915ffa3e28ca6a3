// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/report/drawn_frames.h"

#include <algorithm>

namespace mmm_converter {

using Eigen::Index;
using Eigen::MatrixXd;

DrawnFrames::DrawnFrames(int frames) {
  constexpr int kMostFrames = 6000;
  every_ = std::max(1, (frames + kMostFrames - 1) / kMostFrames);
  count_ = (frames + every_ - 1) / every_;
}

MatrixXd DrawnFrames::Of(const MatrixXd& frames) const {
  return frames(Eigen::seqN(0, count_, every_), Eigen::all);
}

MatrixXd DrawnFrames::LeastOf(const MatrixXd& frames) const { return -MostOf(-frames); }

MatrixXd DrawnFrames::MostOf(const MatrixXd& frames) const {
  MatrixXd most(count_, frames.cols());
  for (Index c = 0; c < frames.cols(); ++c) {
    for (Index i = 0; i < count_; ++i) {
      const Index begin = i * every_;
      const Index size = std::min<Index>(every_, frames.rows() - begin);
      most(i, c) = frames.col(c).segment(begin, size).maxCoeff<Eigen::PropagateNumbers>();
    }
  }
  return most;
}

}  // namespace mmm_converter
