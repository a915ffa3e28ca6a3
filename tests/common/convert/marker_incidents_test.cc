// SPDX-License-Identifier: MIT
#include "common/convert/marker_incidents.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace mmm_converter {
namespace {

using Kind = MarkerIncident::Kind;

TEST(MarkerIncidents, NoneWhereAllIsAsLabelled) {
  EXPECT_TRUE(FindIncidents(Eigen::MatrixXi::Constant(3, 5, kAsLabelled), 2).empty());
  EXPECT_TRUE(FindIncidents(Eigen::MatrixXi(0, 0), 2).empty());
}

TEST(MarkerIncidents, ASwapIsNamedOnceAndSortedByItsFirstFrame) {
  Eigen::MatrixXi verdicts = Eigen::MatrixXi::Constant(4, 10, kAsLabelled);
  verdicts.row(1).segment(4, 3).setConstant(3);
  verdicts.row(3).segment(4, 3).setConstant(1);
  verdicts.row(2).segment(0, 2).setConstant(2);
  const std::vector<MarkerIncident> expected = {{Kind::kMisplaced, 2, -1, 0, 1},
                                                {Kind::kSwapped, 1, 3, 4, 6}};
  EXPECT_EQ(FindIncidents(verdicts, 0), expected);
  EXPECT_STREQ(Name(Kind::kSwapped), "swapped");
  EXPECT_STREQ(Name(Kind::kMisplaced), "misplaced");
}

TEST(MarkerIncidents, AShortStopIsBridgedALongOneIsNot) {
  Eigen::MatrixXi verdicts = Eigen::MatrixXi::Constant(1, 10, kAsLabelled);
  for (const int k : {0, 1, 4, 8}) verdicts(0, k) = 0;
  const std::vector<MarkerIncident> expected = {{Kind::kMisplaced, 0, -1, 0, 4},
                                                {Kind::kMisplaced, 0, -1, 8, 8}};
  EXPECT_EQ(FindIncidents(verdicts, 2), expected);
}

TEST(MarkerIncidents, ASwapDoesNotGoOnAsAJump) {
  Eigen::MatrixXi verdicts = Eigen::MatrixXi::Constant(2, 4, kAsLabelled);
  verdicts.col(0) << 0, 1;
  verdicts.col(1) << 1, 0;
  verdicts.col(2) << 1, 0;
  const std::vector<MarkerIncident> expected = {{Kind::kMisplaced, 0, -1, 0, 0},
                                                {Kind::kMisplaced, 1, -1, 0, 0},
                                                {Kind::kSwapped, 0, 1, 1, 2}};
  std::vector<MarkerIncident> found = FindIncidents(verdicts, 2);
  EXPECT_TRUE(std::is_permutation(found.begin(), found.end(), expected.begin(), expected.end()));
}

}  // namespace
}  // namespace mmm_converter
