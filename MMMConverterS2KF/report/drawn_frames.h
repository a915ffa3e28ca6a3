// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

namespace mmm_converter {

/// Which frames of a recording a page draws: the first of each block of `every` frames, such that
/// there are at most 6000 blocks. In matrices each row is a frame.
class DrawnFrames {
 public:
  explicit DrawnFrames(int frames);

  bool are_all() const { return every_ == 1; }
  int every() const { return every_; }
  int count() const { return count_; }
  int frame(int drawn) const { return drawn * every_; }  ///< of the recording

  Eigen::MatrixXd Of(const Eigen::MatrixXd& frames) const;
  /// Over each block, so that no peak between drawn frames is lost; NaN: all of it is.
  Eigen::MatrixXd LeastOf(const Eigen::MatrixXd& frames) const;
  Eigen::MatrixXd MostOf(const Eigen::MatrixXd& frames) const;

 private:
  int every_ = 1;
  int count_ = 0;
};

}  // namespace mmm_converter
