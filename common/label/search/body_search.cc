// SPDX-License-Identifier: MIT
#include "common/label/search/body_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "common/label/search/posture_step.h"
#include "common/math/statistics.h"
#include "common/support/units.h"

namespace mmm_converter {

using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::MatrixXd;
using Eigen::Ref;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

constexpr int kYaws = 24;

// Of the annealing: spread [m], steps to it, postures that go on.
struct Stage {
  double from, to;
  int steps;
  std::size_t kept;
};
constexpr std::size_t kDrawn = 128;  // at a time; others only where the best of these are not good
constexpr std::size_t kMostDrawn = 256;
constexpr std::array<Stage, 3> kStages = {
    {{0.20, 0.12, 5, 40}, {0.12, 0.07, 5, 20}, {0.07, 0.03, 6, 20}}};
// Of the last postures, in any case; the others only where the best of these is not good.
constexpr std::size_t kSettledFirst = 4;

constexpr double kDrawnTo = 0.03;  // [m]

// Of limbs: from each of the last postures, from the best of them, and from that as long as it is
// not good.
struct Throws {
  int first, once, more;
};
constexpr Throws kThrowsAlone = {40, 100, 300};
constexpr Throws kThrowsWithWholeBody = {0, 40, 120};
// Of the cost that no match at all would have; where markers are hidden, ghosts hide how many.
constexpr double kGoodShare = 0.1;
constexpr double kGoodShareHidden = 0.15;

/// Distance from the nearest of some points, cut off, on a grid.
class DistanceGrid {
 public:
  static constexpr double kCell = 0.04;     // [m]
  static constexpr double kFarthest = 0.2;  // [m]
  static constexpr int kCells = 96;         // in each direction, for a person and their reach

  DistanceGrid(const Ref<const Matrix3Xd>& points, const Vector3d& centre)
      : origin_(centre.array() - 0.5 * kCells * kCell) {
    cells_.assign(static_cast<std::size_t>(kCells) * kCells * kCells, kFarthest);
    constexpr int kReach = static_cast<int>(kFarthest / kCell);
    for (Eigen::Index p = 0; p < points.cols(); ++p) {
      const Vector3d at = InCells(points.col(p));
      const Eigen::Vector3i middle = at.array().floor().cast<int>();
      for (int x = std::max(middle[0] - kReach, 0); x < std::min(middle[0] + kReach + 1, kCells);
           ++x) {
        for (int y = std::max(middle[1] - kReach, 0); y < std::min(middle[1] + kReach + 1, kCells);
             ++y) {
          for (int z = std::max(middle[2] - kReach, 0);
               z < std::min(middle[2] + kReach + 1, kCells); ++z) {
            float& cell = cells_[Index(x, y, z)];
            const double distance = kCell * (Vector3d(x + 0.5, y + 0.5, z + 0.5) - at).norm();
            cell = std::min(cell, static_cast<float>(distance));
          }
        }
      }
    }
  }

  double At(const Vector3d& p) const {
    const Eigen::Array3i cell = InCells(p).array().floor().cast<int>();
    if ((cell < 0).any() || (cell >= kCells).any()) {
      return kFarthest;
    }
    return cells_[Index(cell[0], cell[1], cell[2])];
  }

 private:
  /// No farther off than an int can say.
  Vector3d InCells(const Vector3d& p) const {
    constexpr double kMost = 1e6;
    return ((p - origin_) / kCell).cwiseMax(-kMost).cwiseMin(kMost);
  }
  std::size_t Index(int x, int y, int z) const {
    return (static_cast<std::size_t>(x) * kCells + y) * kCells + z;
  }

  Vector3d origin_;
  std::vector<float> cells_;
};

/// The mean of the points within reach of their middle (median): some are far from everybody.
Vector3d MiddleOf(const Ref<const Matrix3Xd>& points) {
  constexpr double kReach = 1.5;  // [m]
  Vector3d median;
  std::vector<double> sorted(static_cast<std::size_t>(points.cols()));
  for (int i = 0; i < 3; ++i) {
    std::copy(points.row(i).begin(), points.row(i).end(), sorted.begin());
    median[i] = Median(sorted);
  }
  Vector3d sum = Vector3d::Zero();
  int count = 0;
  for (Eigen::Index p = 0; p < points.cols(); ++p) {
    if ((points.col(p) - median).norm() > kReach) continue;
    sum += points.col(p);
    ++count;
  }
  return count > 0 ? Vector3d(sum / count) : median;
}

/// Upright, bent forward, on each side, and upside down.
const std::vector<Matrix3d>& Tilts() {
  static const std::vector<Matrix3d> kTilts = [] {
    constexpr double kRight = EIGEN_PI / 2;
    std::vector<Matrix3d> tilts = {Matrix3d::Identity()};
    for (const double angle : {kRight, -kRight, 2 * kRight, -0.5 * kRight}) {
      tilts.emplace_back(AngleAxisd(angle, Vector3d::UnitX()));
    }
    for (const double angle : {kRight, -kRight}) {
      tilts.emplace_back(AngleAxisd(angle, Vector3d::UnitY()));
    }
    return tilts;
  }();
  return kTilts;
}

}  // namespace

BodySearch::BodySearch(const LabelBody& body, LimbThrows throws)
    : body_(body), throws_(throws), equations_(body.kinematics), limbs_(body), random_(1) {}

std::vector<BodySearch::Candidate> BodySearch::Candidates(const Ref<const Matrix3Xd>& points) {
  const Vector3d middle = MiddleOf(points);
  const DistanceGrid grid(points, middle);
  std::vector<Candidate> candidates;
  Matrix3Xd turned(3, body_.num_markers());
  std::array<double, kYaws> costs = {};
  for (const Posture& start : body_.templates) {
    const Matrix3Xd& markers = equations_.Place(start);
    const Vector3d centre = markers.rowwise().mean();
    for (const Matrix3d& tilt : Tilts()) {
      const auto turn = [&](int yaw) -> Matrix3d {
        return AngleAxisd(yaw * 2 * EIGEN_PI / kYaws, Vector3d::UnitZ()) * tilt;
      };
      for (int yaw = 0; yaw < kYaws; ++yaw) {
        turned.noalias() = turn(yaw) * markers;
        const Vector3d shift = middle - turn(yaw) * centre;
        costs[yaw] = 0;
        for (Eigen::Index m = 0; m < turned.cols(); ++m) {
          costs[yaw] += grid.At(turned.col(m) + shift);
        }
      }
      for (int yaw = 0; yaw < kYaws; ++yaw) {
        if (costs[yaw] > costs[(yaw + 1) % kYaws] ||
            costs[yaw] > costs[(yaw + kYaws - 1) % kYaws]) {
          continue;
        }
        Candidate candidate;
        candidate.posture.orientation = Eigen::Quaterniond(turn(yaw));
        candidate.posture.position = middle - turn(yaw) * centre;
        candidate.posture.joint_angles = start.joint_angles;
        candidate.cost = costs[yaw];
        candidates.push_back(std::move(candidate));
      }
    }
  }
  return candidates;
}

void BodySearch::Step(const MatrixXd& targets, const VectorXd& noise, Posture* posture) {
  constexpr double kNoLimit = 1e9;
  StepTowards(targets, noise, kNoLimit, body_, &equations_, posture);
}

void BodySearch::Draw(const Ref<const Matrix3Xd>& points, double from, double to, int steps,
                      Posture* posture) {
  for (int i = 0; i < steps; ++i) {
    const double spread = from * std::pow(to / from, i / std::max(steps - 1.0, 1.0));
    variances_ = body_.place.array().square() + spread * spread;
    soft_.Compute(equations_.Place(*posture), variances_, points);
    noise_ = (variances_.array() / soft_.weights().array().max(1e-9)).sqrt();
    Step(soft_.targets(), noise_, posture);
  }
}

double BodySearch::SoftCost(const Ref<const Matrix3Xd>& points, const Posture& posture,
                            double spread) {
  const Matrix3Xd& places = equations_.Place(posture);
  double cost =
      MatchCosts::kNaturalWeight * (posture.joint_angles - body_.natural_angles).squaredNorm();
  VectorXd nearest =
      VectorXd::Constant(points.cols(), MatchCosts::kUnmatched);  // marker of each point
  for (int m = 0; m < body_.num_markers(); ++m) {
    const double variance = body_.place[m] * body_.place[m] + spread * spread;
    const Eigen::RowVectorXd d2 =
        (points.colwise() - places.col(m)).colwise().squaredNorm() / variance;
    cost += std::min(d2.minCoeff(), MatchCosts::kUnmatched);
    nearest = nearest.cwiseMin(d2.transpose());
  }
  return cost + nearest.sum();
}

BodyMatch BodySearch::Match(const Ref<const Matrix3Xd>& points, const Posture& posture,
                            double settled) {
  const Matrix3Xd& places = equations_.Place(posture);
  cost_.resize(body_.num_markers(), points.cols());
  for (int m = 0; m < body_.num_markers(); ++m) {
    const double variance = body_.place[m] * body_.place[m] + settled * settled;
    cost_.row(m) = (points.colwise() - places.col(m)).colwise().squaredNorm() / variance;
  }
  BodyMatch match;
  match.point_of_marker = assignment_.Solve(cost_, MatchCosts::kUnmatched);
  match.posture = posture;
  match.cost = assignment_.cost() + MatchCosts::kNaturalWeight *
                                        (posture.joint_angles - body_.natural_angles).squaredNorm();
  match.matched =
      static_cast<int>(std::count_if(match.point_of_marker.begin(), match.point_of_marker.end(),
                                     [](int point) { return point >= 0; }));
  return match;
}

BodyMatch BodySearch::Settle(const Ref<const Matrix3Xd>& points, const Posture& posture,
                             double settled) {
  constexpr int kMostTurns = 6;
  constexpr double kLeastGain = 0.1;
  BodyMatch best = Match(points, posture, settled);
  for (int i = 0; i < kMostTurns; ++i) {
    targets_.setConstant(3, body_.num_markers(), kNaN);
    for (int m = 0; m < body_.num_markers(); ++m) {
      if (best.point_of_marker[m] >= 0) targets_.col(m) = points.col(best.point_of_marker[m]);
    }
    Posture next = best.posture;
    noise_ = (body_.place.array().square() + settled * settled).sqrt();
    equations_.Place(next);
    Step(targets_, noise_, &next);
    BodyMatch match = Match(points, next, settled);
    const double gain = best.cost - match.cost;
    if (gain > 0) best = std::move(match);
    if (gain < kLeastGain) break;
  }
  return best;
}

bool BodySearch::ThrowLimb(const BodyMatch& match, Posture* posture) {
  // A marker is drawn by what it costs more than a good one.
  VectorXd costs(body_.num_markers());
  for (int m = 0; m < costs.size(); ++m) {
    const int point = match.point_of_marker[m];
    costs[m] = point < 0 ? MatchCosts::kUnmatched : std::max(cost_(m, point) - 3, 0.0);
  }
  const std::vector<int>& joints = body_.joints_of_marker[IndexAtShare(random_.Uniform(), costs)];
  if (joints.empty()) return false;
  // The outer half of the chain, or all of it.
  const std::size_t first = random_.Uniform() < 0.5 ? 0 : joints.size() / 2;
  for (std::size_t i = first; i < joints.size(); ++i) {
    const int j = joints[i];
    const auto [lower, upper] = body_.kinematics.Range(j);
    posture->joint_angles[j] = lower + random_.Uniform() * (upper - lower);
  }
  return true;
}

void BodySearch::ImproveWithWholeBody(const Ref<const Matrix3Xd>& points, int attempts,
                                      BodyMatch* match) {
  constexpr double kThrownFrom = 0.12;  // [m]
  constexpr int kSteps = 8;
  constexpr double kLeastGain = 1;
  for (int i = 0; i < attempts; ++i) {
    *match = Match(points, match->posture);
    Posture posture = match->posture;
    if (!ThrowLimb(*match, &posture)) continue;
    Draw(points, kThrownFrom, kDrawnTo, kSteps, &posture);
    BodyMatch trial = Settle(points, posture);
    if (trial.cost < match->cost - kLeastGain) *match = std::move(trial);
  }
}

void BodySearch::ImproveLimbs(const Ref<const Matrix3Xd>& points, int attempts, BodyMatch* match) {
  if (throws_ == LimbThrows::kWithWholeBody) {
    ImproveWithWholeBody(points, attempts, match);
    return;
  }
  BodyMatch better = *match;
  if (!limbs_.Improve(points, attempts, &random_, &better)) return;
  better = Settle(points, better.posture);
  if (better.cost < match->cost) *match = std::move(better);
}

BodyMatch BodySearch::SettleFinely(const Ref<const Matrix3Xd>& points, const Posture& posture) {
  return Settle(points, posture, 0);
}

BodyMatch BodySearch::FindNear(const Ref<const Matrix3Xd>& points, const Posture& posture,
                               double spread) {
  constexpr int kSteps = 10;
  Posture drawn = posture;
  Draw(points, spread, kDrawnTo, kSteps, &drawn);
  return Settle(points, drawn);
}

void BodySearch::Sort(std::vector<Candidate>* candidates) {
  std::sort(candidates->begin(), candidates->end(),
            [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; });
}

void BodySearch::DrawAll(const Ref<const Matrix3Xd>& points, std::vector<Candidate>* candidates) {
  for (const Stage& stage : kStages) {
    for (Candidate& candidate : *candidates) {
      Draw(points, stage.from, stage.to, stage.steps, &candidate.posture);
      candidate.cost = SoftCost(points, candidate.posture, stage.to);
    }
    Sort(candidates);
    candidates->resize(std::min(stage.kept, candidates->size()));
  }
}

BodyMatch BodySearch::Find(const Ref<const Matrix3Xd>& points) {
  random_ = SeededRandom(1);
  std::vector<Candidate> candidates = Candidates(points);
  Sort(&candidates);
  candidates.resize(std::min(kMostDrawn, candidates.size()));
  const auto markers = static_cast<double>(body_.num_markers());
  const double hidden = std::max(markers - static_cast<double>(points.cols()), 0.0);  // at least
  const double good =
      MatchCosts::kUnmatched * (hidden + markers * (hidden > 0 ? kGoodShareHidden : kGoodShare));
  const Throws& throws =
      throws_ == LimbThrows::kWithWholeBody ? kThrowsWithWholeBody : kThrowsAlone;
  BodyMatch best;
  best.cost = std::numeric_limits<double>::infinity();
  const auto is_good = [&] { return best.cost <= good; };
  for (std::size_t begin = 0; begin < candidates.size() && !is_good(); begin += kDrawn) {
    const std::size_t end = std::min(begin + kDrawn, candidates.size());
    std::vector<Candidate> drawn(std::make_move_iterator(candidates.begin() + begin),
                                 std::make_move_iterator(candidates.begin() + end));
    DrawAll(points, &drawn);
    for (std::size_t i = 0; i < drawn.size() && (i < kSettledFirst || !is_good()); ++i) {
      BodyMatch match = Settle(points, drawn[i].posture);
      ImproveLimbs(points, throws.first, &match);
      if (match.cost < best.cost) best = std::move(match);
    }
  }
  ImproveLimbs(points, throws.once, &best);
  for (int i = 0; i < throws.more && !is_good(); i += throws.once) {
    ImproveLimbs(points, throws.once, &best);
  }
  return best;
}

}  // namespace mmm_converter
