// SPDX-License-Identifier: MIT
#include "common/label/search/body_search.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>
#include <utility>

#include "common/label/tuning.h"
#include "common/math/statistics.h"

namespace mmm_converter {

using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::Ref;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

/// Distance from the nearest of some points, cut off, on a grid.
class DistanceGrid {
 public:
  static constexpr double kCell = SearchTuning::kCell;
  static constexpr double kFarthest = SearchTuning::kFarthest;
  static constexpr int kCells = SearchTuning::kCells;

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
    constexpr double kMost = SearchTuning::kMostCells;
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
  Vector3d median;
  std::vector<double> sorted(static_cast<std::size_t>(points.cols()));
  for (int i = 0; i < 3; ++i) {
    std::copy(points.row(i).begin(), points.row(i).end(), sorted.begin());
    median[i] = Median(sorted);
  }
  Vector3d sum = Vector3d::Zero();
  int count = 0;
  for (Eigen::Index p = 0; p < points.cols(); ++p) {
    if ((points.col(p) - median).norm() > SearchTuning::kReach) continue;
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

BodySearch::BodySearch(const LabelBody& body, LimbRestarts restarts)
    : body_(body), restarts_(restarts), whole_(body), limbs_(body), random_(1) {}

std::vector<BodySearch::Candidate> BodySearch::TurnedTemplates(const Ref<const Matrix3Xd>& points) {
  const Vector3d middle = MiddleOf(points);
  const DistanceGrid grid(points, middle);
  std::vector<Candidate> candidates;
  Matrix3Xd turned(3, body_.num_markers());
  constexpr int kYaws = SearchTuning::kYaws;
  std::array<double, kYaws> costs = {};
  for (const Posture& start : body_.templates) {
    const Matrix3Xd& markers = whole_.Place(start);
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
        candidate.posture.orientation = Eigen::Quaterniond(turn(yaw)) * start.orientation;
        candidate.posture.position = middle - turn(yaw) * centre;
        candidate.posture.joint_angles = start.joint_angles;
        candidate.cost = costs[yaw];
        candidates.push_back(std::move(candidate));
      }
    }
  }
  return candidates;
}

double BodySearch::SoftCost(const Ref<const Matrix3Xd>& points, const Posture& posture,
                            double spread) {
  const Matrix3Xd& places = whole_.Place(posture);
  double cost = whole_.PostureCost(posture);
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

BodyMatch BodySearch::MatchOf(const Posture& posture, double cost) const {
  BodyMatch match{posture, fit_.point_of_marker(), cost, 0};
  match.matched =
      static_cast<int>(std::count_if(match.point_of_marker.begin(), match.point_of_marker.end(),
                                     [](int point) { return point >= 0; }));
  return match;
}

BodyMatch BodySearch::Match(const Ref<const Matrix3Xd>& points, const Posture& posture,
                            double settled) {
  return MatchOf(posture, fit_.Assign(points, settled, posture, &whole_));
}

BodyMatch BodySearch::Settle(const Ref<const Matrix3Xd>& points, Posture posture, double settled) {
  const double cost =
      fit_.Settle(points, {settled, FitTuning::kMostTurns, true}, &whole_, &posture);
  return MatchOf(posture, cost);
}

bool BodySearch::RandomizeLimb(const BodyMatch& match, Posture* posture) {
  // A marker is chosen by what it costs more than a good one.
  VectorXd costs(body_.num_markers());
  for (int m = 0; m < costs.size(); ++m) {
    const int point = match.point_of_marker[m];
    costs[m] = point < 0 ? MatchCosts::kUnmatched
                         : std::max(fit_.costs()(m, point) - MatchCosts::kGood, 0.0);
  }
  const std::vector<int>& joints = body_.joints_of_marker[IndexAtShare(random_.Uniform(), costs)];
  if (joints.empty()) return false;
  RandomizeJoints(body_.kinematics, joints, false, &random_, posture);
  return true;
}

void BodySearch::ImproveWithWholeBody(const Ref<const Matrix3Xd>& points, int tries,
                                      BodyMatch* match) {
  for (int i = 0; i < tries; ++i) {
    *match = Match(points, match->posture);
    Posture posture = match->posture;
    if (!RandomizeLimb(*match, &posture)) continue;
    fit_.Anneal(points, LimbTuning::kAnnealing, &whole_, &posture);
    BodyMatch trial = Settle(points, posture);
    if (trial.cost < match->cost - LimbTuning::kLeastGain) *match = std::move(trial);
  }
}

void BodySearch::ImproveLimbs(const Ref<const Matrix3Xd>& points, int tries, BodyMatch* match) {
  if (restarts_ == LimbRestarts::kWithWholeBody) {
    ImproveWithWholeBody(points, tries, match);
    return;
  }
  BodyMatch better = *match;
  if (!limbs_.Improve(points, tries, &random_, &better)) return;
  better = Settle(points, better.posture);
  if (better.cost < match->cost) *match = std::move(better);
}

BodyMatch BodySearch::SettleFinely(const Ref<const Matrix3Xd>& points, const Posture& posture) {
  return Settle(points, posture, 0);
}

BodyMatch BodySearch::FindNear(const Ref<const Matrix3Xd>& points, const Posture& posture,
                               double spread) {
  Posture annealed = posture;
  fit_.Anneal(points, {spread, SearchTuning::kNearTo, SearchTuning::kNearSteps}, &whole_,
              &annealed);
  return Settle(points, annealed);
}

void BodySearch::Sort(std::vector<Candidate>* candidates) {
  std::sort(candidates->begin(), candidates->end(),
            [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; });
}

void BodySearch::AnnealAll(const Ref<const Matrix3Xd>& points, std::vector<Candidate>* candidates) {
  for (const SearchTuning::Stage& stage : SearchTuning::kStages) {
    for (Candidate& candidate : *candidates) {
      fit_.Anneal(points, stage.annealing, &whole_, &candidate.posture);
      candidate.cost = SoftCost(points, candidate.posture, stage.annealing.to);
    }
    Sort(candidates);
    candidates->resize(std::min(stage.kept, candidates->size()));
  }
}

BodyMatch BodySearch::Find(const Ref<const Matrix3Xd>& points) {
  random_ = SeededRandom(1);
  std::vector<Candidate> candidates = TurnedTemplates(points);
  Sort(&candidates);
  candidates.resize(std::min(SearchTuning::kMostAnnealed, candidates.size()));
  const auto markers = static_cast<double>(body_.num_markers());
  const double hidden = std::max(markers - static_cast<double>(points.cols()), 0.0);  // at least
  const double good_share = hidden > 0 ? SearchTuning::kGoodShareHidden : SearchTuning::kGoodShare;
  const double good = MatchCosts::kUnmatched * (hidden + markers * good_share);
  const LimbTuning::Tries& tries = restarts_ == LimbRestarts::kWithWholeBody
                                       ? LimbTuning::kTriesWithBody
                                       : LimbTuning::kTriesAlone;
  BodyMatch best;
  best.cost = std::numeric_limits<double>::infinity();
  const auto is_good = [&] { return best.cost <= good; };
  constexpr std::size_t kAtATime = SearchTuning::kAnnealed;
  for (std::size_t begin = 0; begin < candidates.size() && !is_good(); begin += kAtATime) {
    const std::size_t end = std::min(begin + kAtATime, candidates.size());
    std::vector<Candidate> annealed(std::make_move_iterator(candidates.begin() + begin),
                                    std::make_move_iterator(candidates.begin() + end));
    AnnealAll(points, &annealed);
    for (std::size_t i = 0; i < annealed.size(); ++i) {
      if (i >= SearchTuning::kSettledFirst && is_good()) break;
      BodyMatch match = Settle(points, annealed[i].posture);
      ImproveLimbs(points, tries.first, &match);
      if (match.cost < best.cost) best = std::move(match);
    }
  }
  ImproveLimbs(points, tries.once, &best);
  for (int i = 0; i < tries.more && !is_good(); i += tries.once) {
    ImproveLimbs(points, tries.once, &best);
  }
  return best;
}

}  // namespace mmm_converter
