// SPDX-License-Identifier: MIT
#include "common/label/search/linear_assignment.h"

#include <limits>

namespace mmm_converter {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

// A row's own way out, at the price `unassigned`, is an edge to a column of its own that no other
// row can take: the shortest path may end there at any row that it passes.
void LinearAssignment::Augment(const Eigen::Ref<const Eigen::MatrixXd>& cost, double unassigned,
                               int row) {
  const int columns = static_cast<int>(cost.cols());
  distance_.assign(columns, kInfinity);
  previous_.assign(columns, -1);
  done_.assign(columns, 0);
  double reached = 0;  // distance of the row that the search is at
  double best_exit = kInfinity;
  int exit_row = -1;
  int at = row;
  int last = -1;  // a free column, where the path ends in one
  while (true) {
    const double exit = reached + unassigned - row_price_[at];
    if (exit < best_exit) {
      best_exit = exit;
      exit_row = at;
    }
    int nearest = -1;
    double shortest = best_exit;
    for (int c = 0; c < columns; ++c) {
      if (done_[c] != 0) continue;
      const double through = reached + cost(at, c) - row_price_[at] - column_price_[c];
      if (through < distance_[c]) {
        distance_[c] = through;
        previous_[c] = at;
      }
      if (distance_[c] < shortest) {
        shortest = distance_[c];
        nearest = c;
      }
    }
    if (nearest < 0) break;
    if (row_of_column_[nearest] < 0) {
      last = nearest;
      break;
    }
    done_[nearest] = 1;
    reached = shortest;
    at = row_of_column_[nearest];
  }
  const double length = last >= 0 ? distance_[last] : best_exit;
  // Prices: every column and row that was passed before the end of the path.
  for (int c = 0; c < columns; ++c) {
    if (done_[c] == 0) continue;
    row_price_[row_of_column_[c]] += length - distance_[c];
    column_price_[c] += distance_[c] - length;
  }
  row_price_[row] += length;
  // Takes the path back. A row that leaves by its own way gives its column up.
  int column = last;
  if (last < 0) {
    if (exit_row == row) return;
    column = column_of_row_[exit_row];
    column_of_row_[exit_row] = -1;
  }
  while (true) {
    const int before = previous_[column];
    row_of_column_[column] = before;
    std::swap(column, column_of_row_[before]);
    if (before == row) return;
  }
}

const std::vector<int>& LinearAssignment::Solve(const Eigen::Ref<const Eigen::MatrixXd>& cost,
                                                double unassigned) {
  const int rows = static_cast<int>(cost.rows());
  column_of_row_.assign(rows, -1);
  row_of_column_.assign(cost.cols(), -1);
  row_price_.assign(rows, 0);
  column_price_.assign(cost.cols(), 0);
  for (int r = 0; r < rows; ++r) {
    row_price_[r] = cost.cols() == 0 ? unassigned : std::min(unassigned, cost.row(r).minCoeff());
  }
  for (int r = 0; r < rows; ++r) Augment(cost, unassigned, r);
  cost_ = 0;
  for (int r = 0; r < rows; ++r) {
    cost_ += column_of_row_[r] < 0 ? unassigned : cost(r, column_of_row_[r]);
  }
  return column_of_row_;
}

}  // namespace mmm_converter
