// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <vector>

namespace mmm_converter {

/// Vector kernels take rows and columns by so many at a time, whatever the instruction set.
inline constexpr int kPadding = 8;

/// The smallest multiple of kPadding that is not below n.
inline int PaddedSize(int n) { return (n + kPadding - 1) / kPadding * kPadding; }

/// A column-major matrix for vector kernels: rows and columns are padded with zeros to multiples of
/// kPadding, every column starts at a multiple of 64 bytes. Kernels compute the padding too, which
/// stays 0 unless a number is not finite; who writes through view() leaves it as it is.
class PaddedMatrix {
 public:
  PaddedMatrix() = default;
  PaddedMatrix(int rows, int cols)
      : rows_(rows),
        cols_(cols),
        storage_(static_cast<std::size_t>(PaddedSize(rows) / kPadding) * PaddedSize(cols)) {}

  int rows() const { return rows_; }
  int cols() const { return cols_; }
  int padded_rows() const { return PaddedSize(rows_); }  ///< the distance of columns
  int padded_cols() const { return PaddedSize(cols_); }
  double* data() { return storage_.empty() ? nullptr : storage_.front().values; }
  const double* data() const { return storage_.empty() ? nullptr : storage_.front().values; }
  double* col(int i) { return data() + static_cast<std::ptrdiff_t>(i) * padded_rows(); }
  const double* col(int i) const { return data() + static_cast<std::ptrdiff_t>(i) * padded_rows(); }

  /// All entries, the padding too.
  void SetZero() { std::fill(storage_.begin(), storage_.end(), Group()); }
  void SetIdentity() {
    SetZero();
    view().diagonal().setOnes();
  }

  using View = Eigen::Map<Eigen::MatrixXd, Eigen::Unaligned, Eigen::OuterStride<>>;
  using ConstView = Eigen::Map<const Eigen::MatrixXd, Eigen::Unaligned, Eigen::OuterStride<>>;
  View view() { return View(data(), rows_, cols_, Eigen::OuterStride<>(padded_rows())); }
  ConstView view() const {
    return ConstView(data(), rows_, cols_, Eigen::OuterStride<>(padded_rows()));
  }

 private:
  struct alignas(64) Group {
    double values[kPadding] = {};
  };

  int rows_ = 0;
  int cols_ = 0;
  std::vector<Group> storage_;
};

}  // namespace mmm_converter
