// SPDX-License-Identifier: MIT
#include "common/label/search/linear_assignment.h"

#include <gtest/gtest.h>

#include <limits>

#include "common/math/seeded_random.h"

namespace mmm_converter {
namespace {

// Every row tries every free column, or none.
double CheapestByTrying(const Eigen::MatrixXd& cost, double unassigned, int row, unsigned used) {
  if (row == cost.rows()) return 0;
  double best = unassigned + CheapestByTrying(cost, unassigned, row + 1, used);
  for (int c = 0; c < cost.cols(); ++c) {
    if ((used >> c & 1U) != 0) continue;
    best =
        std::min(best, cost(row, c) + CheapestByTrying(cost, unassigned, row + 1, used | 1U << c));
  }
  return best;
}

TEST(LinearAssignmentTest, CostsAsLittleAsTheBestOfAll) {
  SeededRandom random(1);
  LinearAssignment assignment;
  for (int i = 0; i < 2000; ++i) {
    const int rows = random.UniformIndex(6);
    const int columns = random.UniformIndex(7);
    Eigen::MatrixXd cost(rows, columns);
    for (int r = 0; r < rows; ++r) {
      for (int c = 0; c < columns; ++c) {
        // Equal, negative and forbidden costs among them.
        cost(r, c) = random.UniformIndex(5) == 0 ? std::numeric_limits<double>::infinity()
                                                 : random.UniformIndex(12) - 2;
      }
    }
    const double unassigned = random.UniformIndex(10);
    const std::vector<int> columns_of_rows = assignment.Solve(cost, unassigned);
    double sum = 0;
    unsigned used = 0;
    for (int r = 0; r < rows; ++r) {
      const int c = columns_of_rows[r];
      sum += c < 0 ? unassigned : cost(r, c);
      if (c < 0) continue;
      EXPECT_EQ(used >> c & 1U, 0U) << "a column twice";
      used |= 1U << c;
    }
    EXPECT_EQ(sum, assignment.cost());
    EXPECT_EQ(sum, CheapestByTrying(cost, unassigned, 0, 0)) << "case " << i;
  }
}

}  // namespace
}  // namespace mmm_converter
