// SPDX-License-Identifier: MIT
#include "common/label/search/scene_start.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <utility>

#include "common/label/search/body_search.h"
#include "common/label/search/linear_assignment.h"
#include "common/label/tuning.h"
#include "common/math/statistics.h"
#include "common/support/error.h"

namespace mmm_converter {

using Eigen::Matrix3Xd;
using Eigen::MatrixXd;
using Eigen::Vector3d;

namespace {

Vector3d MedianOf(const Matrix3Xd& points) {
  Vector3d median;
  for (int i = 0; i < 3; ++i) {
    median[i] = Median(std::vector<double>(points.row(i).begin(), points.row(i).end()));
  }
  return median;
}

/// Frames of the fullest third, spread over the recording.
std::vector<int> FullestFrames(const std::vector<Matrix3Xd>& frames) {
  std::vector<int> order(frames.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&frames](int a, int b) { return frames[a].cols() > frames[b].cols(); });
  const int all = static_cast<int>(order.size());
  const int candidates =
      std::max(all / SceneTuning::kFullestShare, std::min(all, SceneTuning::kFrames));
  const int count = std::min(candidates, SceneTuning::kFrames);
  std::vector<int> chosen;
  chosen.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    chosen.push_back(order[static_cast<std::size_t>(i) * candidates / count]);
  }
  return chosen;
}

/// Points in as many parts, as seen from above: divided along their longest direction, then each
/// to the part whose median is nearest (k-medians).
std::vector<Matrix3Xd> Parts(const Matrix3Xd& points, int count) {
  if (count == 1) return {points};
  Matrix3Xd flat = points;
  flat.row(2).setZero();
  const Matrix3Xd centred = flat.colwise() - MedianOf(flat);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(centred * centred.transpose());
  const Eigen::VectorXd along = centred.transpose() * axes.eigenvectors().col(2);
  std::vector<int> order(static_cast<std::size_t>(points.cols()));
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&along](int a, int b) { return along[a] < along[b]; });
  std::vector<std::vector<int>> members(count);
  for (std::size_t i = 0; i < order.size(); ++i) {
    members[i * count / order.size()].push_back(order[i]);
  }
  Matrix3Xd centres = Matrix3Xd::Zero(3, count);
  for (int turn = 0; turn < SceneTuning::kMedianTurns; ++turn) {
    for (int c = 0; c < count; ++c) {
      if (!members[c].empty()) centres.col(c) = MedianOf(flat(Eigen::all, members[c]));
    }
    for (std::vector<int>& part : members) part.clear();
    for (int p = 0; p < points.cols(); ++p) {
      Eigen::Index nearest = 0;
      (centres.colwise() - flat.col(p)).colwise().squaredNorm().minCoeff(&nearest);
      members[nearest].push_back(p);
    }
  }
  std::vector<Matrix3Xd> parts;
  parts.reserve(members.size());
  for (const std::vector<int>& part : members) parts.emplace_back(points(Eigen::all, part));
  return parts;
}

}  // namespace

std::vector<SceneStart> FindScene(const std::vector<const LabelBody*>& bodies,
                                  const std::vector<Matrix3Xd>& frames,
                                  const std::function<void()>& between_frames) {
  const auto count = static_cast<int>(bodies.size());
  std::vector<std::unique_ptr<BodySearch>> searches;
  searches.reserve(bodies.size());
  for (const LabelBody* body : bodies) searches.push_back(std::make_unique<BodySearch>(*body));
  std::vector<std::pair<double, SceneStart>> starts;  // with their costs
  for (const int k : FullestFrames(frames)) {
    if (between_frames) between_frames();
    if (frames[k].cols() < BodyLimits::kFewestMarkers * count) continue;
    const std::vector<Matrix3Xd> parts = Parts(frames[k], count);
    // Who is in which part.
    MatrixXd costs = MatrixXd::Constant(count, count, 0);
    std::vector<BodyMatch> matches(bodies.size() * bodies.size());
    bool has_points = true;
    for (const Matrix3Xd& part : parts)
      has_points = has_points && part.cols() >= BodyLimits::kFewestMarkers;
    if (!has_points) continue;
    for (int b = 0; b < count; ++b) {
      for (int c = 0; c < count; ++c) {
        BodyMatch& match = matches[b * bodies.size() + c];
        match = searches[b]->Find(parts[c]);
        costs(b, c) = match.cost;
      }
    }
    LinearAssignment assignment;
    const std::vector<int> part_of = assignment.Solve(costs, costs.sum() + 1);
    SceneStart start{k, {}};
    for (int b = 0; b < count; ++b) {
      start.matches.push_back(matches[b * bodies.size() + part_of[b]]);
    }
    starts.emplace_back(assignment.cost(), std::move(start));
  }
  std::stable_sort(starts.begin(), starts.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  for (int b = 0; b < count; ++b) {
    const int matched = starts.empty() ? 0 : starts.front().second.matches[b].matched;
    if (2 * matched >= bodies[b]->num_markers()) continue;
    if (count == 1 && 4 * matched >= bodies[b]->num_markers()) {
      const SceneStart& best = starts.front().second;
      CheckSize(*bodies[b], frames[best.frame], best.matches[b]);
    }
    throw Error(fmt::format(
        "no frame shows {}: of {} markers at most {} fit any posture of this body; is it the right "
        "person, height and set of markers{}?",
        count == 1 ? "a person" : fmt::format("person {}", b + 1), bodies[b]->num_markers(),
        matched, count == 1 ? "" : ", and do the persons stand apart in some frames"));
  }
  std::vector<SceneStart> best_first;
  best_first.reserve(starts.size());
  for (auto& [cost, start] : starts) best_first.push_back(std::move(start));
  return best_first;
}

void CheckSize(const LabelBody& body, const Matrix3Xd& points, const BodyMatch& match) {
  if (match.cost < SceneTuning::kBadCost * body.num_markers()) return;
  BodySearch search(body);
  double least = SceneTuning::kClearlyFewer * match.cost, best = 1;
  for (double size = SceneTuning::kLeastScale; size < SceneTuning::kMostScale;
       size *= SceneTuning::kScaleStep) {
    if (std::abs(size - 1) < SceneTuning::kOtherSize) continue;
    const double cost = search.Find(points / size).cost;
    if (cost >= least) continue;
    least = cost;
    best = size;
  }
  if (best == 1) return;
  throw Error(fmt::format(
      "the points are those of a person who is {:.2f} times as tall; are the height and the file's "
      "unit right?",
      best));
}

}  // namespace mmm_converter
