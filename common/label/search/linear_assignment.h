// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

namespace mmm_converter {

/// The cheapest assignment of rows to columns in which every column is used once at most, and a row
/// may stay without one (Kuhn 1955; by shortest augmenting paths, Jonker and Volgenant 1987).
/// Keeps its memory from call to call.
class LinearAssignment {
 public:
  /// cost: rows x columns, finite or infinity where a pair is not allowed. unassigned: what a row
  /// without column costs, finite. Returns the column of each row, -1: none; valid until the next
  /// call.
  const std::vector<int>& Solve(const Eigen::Ref<const Eigen::MatrixXd>& cost, double unassigned);

  /// Of the last solution.
  double cost() const { return cost_; }

 private:
  void Augment(const Eigen::Ref<const Eigen::MatrixXd>& cost, double unassigned, int row);

  std::vector<int> column_of_row_, row_of_column_;
  std::vector<double> row_price_, column_price_;
  std::vector<double> distance_;  // of columns from the row, by reduced costs
  std::vector<int> previous_;     // the row before a column
  std::vector<char> done_;        // by column
  double cost_ = 0;
};

}  // namespace mmm_converter
