// SPDX-License-Identifier: MIT
#include "tests/support/unnamed_points.h"

#include <algorithm>
#include <numeric>
#include <string>

#include "common/math/seeded_random.h"
#include "tests/support/changed_markers.h"

namespace mmm_converter::testing {

namespace {

struct Ghost {
  int frames = 0;  // that it lives on
  int marker = -1;
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  // relative to the marker, or in W [m]
};

Ghost Appear(const Eigen::Ref<const Eigen::Matrix3Xd>& markers, double rate, SeededRandom* random) {
  Ghost ghost;
  ghost.frames = 1 + random->Poisson(0.2 * rate);
  std::vector<int> seen;
  for (int m = 0; m < markers.cols(); ++m) {
    if (IsSeen(markers.col(m))) seen.push_back(m);
  }
  if (seen.empty()) return ghost;
  const int marker = seen[random->UniformIndex(static_cast<int>(seen.size()))];
  if (random->Uniform() < 0.5) {
    ghost.marker = marker;
    const Eigen::Vector3d direction(random->Normal(), random->Normal(), random->Normal());
    ghost.place = (0.03 + 0.12 * random->Uniform()) * direction.normalized();
  } else {
    for (int i = 0; i < 3; ++i) {
      ghost.place[i] = markers(i, marker) + 2 * random->Uniform() - 1;
    }
  }
  return ghost;
}

}  // namespace

UnnamedPoints MakeUnnamed(const MarkerSequence& recording, const UnnamedErrors& errors,
                          std::uint64_t seed) {
  MarkerSequence markers = recording;
  if (errors.hidden > 0) {
    const double block = std::max(1.0, 0.5 * recording.rate());
    markers = testing::OccludeShare(markers, errors.hidden, block, seed);
  }
  const int columns = recording.num_labels() + errors.ghosts;
  std::vector<std::string> names;
  names.reserve(columns);
  for (int c = 0; c < columns; ++c) names.push_back("*" + std::to_string(c + 1));
  UnnamedPoints made = {
      MarkerSequence(names, recording.num_frames(), recording.rate(), recording.first_time()), {}};
  made.truth.assign(recording.num_frames(), std::vector<int>(columns, -1));
  SeededRandom random(seed + 1000);
  std::vector<Ghost> ghosts(errors.ghosts);
  std::vector<int> order(columns);
  std::iota(order.begin(), order.end(), 0);
  for (int k = 0; k < recording.num_frames(); ++k) {
    if (errors.shuffled) {
      for (int c = columns - 1; c > 0; --c) std::swap(order[c], order[random.UniformIndex(c + 1)]);
    }
    for (int m = 0; m < recording.num_labels(); ++m) {
      made.points.frame(k).col(order[m]) = markers.frame(k).col(m);
      if (IsSeen(markers.frame(k).col(m))) made.truth[k][order[m]] = m;
    }
    for (int g = 0; g < errors.ghosts; ++g) {
      Ghost& ghost = ghosts[g];
      if (--ghost.frames <= 0) ghost = Appear(recording.frame(k), recording.rate(), &random);
      Eigen::Vector3d place = ghost.place;
      if (ghost.marker >= 0) place += recording.frame(k).col(ghost.marker);
      made.points.frame(k).col(order[recording.num_labels() + g]) = place;
    }
  }
  return made;
}

LabelScore ScoreLabels(const UnnamedPoints& made, const Labelling& labelling,
                       const std::vector<int>& names) {
  LabelScore score;
  double markers = 0;
  for (const auto& frame : made.truth) {
    markers += static_cast<double>(
        std::count_if(frame.begin(), frame.end(), [](int label) { return label >= 0; }));
  }
  for (const NamedPiece& piece : labelling.pieces) {
    if (piece.name < 0) continue;
    for (int k = piece.begin; k < piece.end; ++k) {
      if (!IsSeen(made.points.frame(k).col(piece.point))) continue;
      const int truth = made.truth[k][piece.point];
      if (truth < 0) {
        score.ghosts_named += 1;
      } else if (truth == names[piece.name]) {
        score.right += 1;
      } else {
        score.wrong += 1;
      }
    }
  }
  score.right /= markers;
  score.wrong /= markers;
  score.ghosts_named /= markers;
  return score;
}

}  // namespace mmm_converter::testing
