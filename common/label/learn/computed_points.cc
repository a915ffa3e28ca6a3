// SPDX-License-Identifier: MIT
#include "common/label/learn/computed_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "common/io/recording/marker_labels.h"
#include "common/label/tuning.h"
#include "common/math/statistics.h"

namespace mmm_converter {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

namespace {

using Track = Matrix3Xd;  // 3 x frames; NaN: not seen

std::vector<Track> TracksOf(std::size_t labels, const std::vector<LearnFrame>& frames) {
  std::vector<Track> tracks(labels, Track(3, static_cast<Eigen::Index>(frames.size())));
  for (std::size_t l = 0; l < labels; ++l) {
    for (std::size_t k = 0; k < frames.size(); ++k) {
      tracks[l].col(static_cast<Eigen::Index>(k)) = frames[k].z.col(static_cast<Eigen::Index>(l));
    }
  }
  return tracks;
}

std::string WhyByName(const std::string& label) {
  constexpr std::array<std::string_view, 10> kAtEnd = {
      "angle", "angles", "force", "forces", "moment", "moments", "power", "powers", "jc", "com"};
  constexpr std::array<std::string_view, 7> kAnywhere = {
      "virtual",    "jointcent",   "centerofmass",  "centreofmass",
      "centerofpr", "centreofpre", "groundreaction"};
  const std::string name = NormalizeLabel(label);
  const bool is_computed =
      std::any_of(kAtEnd.begin(), kAtEnd.end(),
                  [&](std::string_view end) { return name.ends_with(end); }) ||
      std::any_of(kAnywhere.begin(), kAnywhere.end(),
                  [&](std::string_view part) { return name.find(part) != std::string::npos; });
  return is_computed ? "by its name a computed point (an angle, a force, a joint centre)" : "";
}

/// Standard deviation of the distance of two points; nothing where they are seldom seen together.
std::optional<double> VariationOf(const Track& a, const Track& b) {
  const Eigen::ArrayXd distance = (a - b).colwise().norm().transpose();
  double sum = 0, squares = 0;
  int count = 0;
  for (const double d : distance) {
    if (!std::isfinite(d)) continue;
    sum += d;
    squares += d * d;
    ++count;
  }
  if (count < ComputedTuning::kFewestCompared) return std::nullopt;
  return std::sqrt(std::max(0.0, squares / count - (sum / count) * (sum / count)));
}

/// The largest distance from the mean; infinite where there are few columns.
double RadiusOf(const Matrix3Xd& p) {
  Vector3d mean = Vector3d::Zero();
  int count = 0;
  for (const auto& one : p.colwise()) {
    if (!one.allFinite()) continue;
    mean += one;
    ++count;
  }
  if (count < ComputedTuning::kFewestCompared) return std::numeric_limits<double>::infinity();
  mean /= count;
  double largest = 0;
  for (const auto& one : p.colwise()) {
    if (one.allFinite()) largest = std::max(largest, (one - mean).norm());
  }
  return largest;
}

bool IsExact(double error, double variation) {
  return error < ComputedTuning::kExactly && error < ComputedTuning::kShareOfSkin * variation;
}

/// Whether a point is at the same share of the way between two others whose distance varies.
bool IsBetween(const Track& p, const Track& a, const Track& b) {
  const auto variation = VariationOf(a, b);
  if (!variation || *variation * ComputedTuning::kShareOfSkin < ComputedTuning::kLeastSkin)
    return false;
  const Track along = b - a;
  double dot = 0, square = 0;
  for (Eigen::Index k = 0; k < p.cols(); ++k) {
    const double one = along.col(k).dot(p.col(k) - a.col(k));
    if (!std::isfinite(one)) continue;
    dot += one;
    square += along.col(k).squaredNorm();
  }
  const double share = square > 0 ? dot / square : 0;
  if (share < ComputedTuning::kAtAnEnd || share > 1 - ComputedTuning::kAtAnEnd) return false;
  const Eigen::VectorXd errors = (p - a - share * along).colwise().norm();
  const std::vector<double> values(errors.begin(), errors.end());
  const double error = Max(values);
  return std::isfinite(error) && IsExact(error, *variation);
}

/// A point in axes that three others span, the way that joint centres are computed: from the middle
/// of the first two, along these, and across the plane of all.
Track InAxesOf(const Track& p, const Track& a, const Track& b, const Track& c) {
  Track local(3, p.cols());
  for (Eigen::Index k = 0; k < p.cols(); ++k) {
    Eigen::Matrix3d R;
    R.col(0) = (b.col(k) - a.col(k)).normalized();
    R.col(2) = R.col(0).cross(c.col(k) - a.col(k)).normalized();
    R.col(1) = R.col(2).cross(R.col(0));
    local.col(k) = R.transpose() * (p.col(k) - (a.col(k) + b.col(k)) / 2);
  }
  return local;
}

/// Tells of one label at a time whether it is computed from others.
class Functions {
 public:
  Functions(const std::vector<std::string>& labels, const std::vector<Track>& tracks)
      : labels_(labels), tracks_(tracks) {}

  /// others: labels that it may be computed from.
  std::string WhyFunction(int label, const std::vector<int>& others) const {
    const std::vector<int> near = Nearest(label, others);
    for (const int a : near) {
      for (const int b : near) {
        if (b <= a || !IsBetween(tracks_[label], tracks_[a], tracks_[b])) continue;
        return fmt::format("computed: always between {} and {}", labels_[a], labels_[b]);
      }
    }
    return WhyInAxes(label, near);
  }

 private:
  std::vector<int> Nearest(int label, const std::vector<int>& others) const {
    std::vector<std::pair<double, int>> by_variation;
    for (const int other : others) {
      if (const auto variation = VariationOf(tracks_[label], tracks_[other])) {
        by_variation.emplace_back(*variation, other);
      }
    }
    std::sort(by_variation.begin(), by_variation.end());
    if (by_variation.size() > ComputedTuning::kNearest)
      by_variation.resize(ComputedTuning::kNearest);
    std::vector<int> nearest;
    nearest.reserve(by_variation.size());
    for (const auto& [unused, other] : by_variation) nearest.push_back(other);
    return nearest;
  }

  std::string WhyInAxes(int label, const std::vector<int>& near) const {
    for (const int a : near) {
      for (const int b : near) {
        if (b <= a) continue;
        for (const int c : near) {
          if (c == a || c == b || !IsInAxes(label, a, b, tracks_[c], c)) continue;
          return fmt::format("computed: always at the same place in axes of {}, {} and {}",
                             labels_[a], labels_[b], labels_[c]);
        }
        for (const int c : near) {
          for (const int d : near) {
            if (d <= c || c == a || c == b || d == a || d == b) continue;
            if (!IsInAxes(label, a, b, (tracks_[c] + tracks_[d]) / 2, c)) continue;
            return fmt::format(
                "computed: always at the same place in axes of {}, {} and the middle of {} and {}",
                labels_[a], labels_[b], labels_[c], labels_[d]);
          }
        }
      }
    }
    return "";
  }

  /// third: a point that gives the plane; like: a label of it.
  bool IsInAxes(int label, int a, int b, const Track& third, int like) const {
    const auto ab = VariationOf(tracks_[a], tracks_[b]);
    const auto ac = VariationOf(tracks_[a], tracks_[like]);
    if (!ab || !ac) return false;
    const double variation = std::max(*ab, *ac);
    return variation * ComputedTuning::kShareOfSkin > ComputedTuning::kLeastSkin &&
           IsExact(RadiusOf(InAxesOf(tracks_[label], tracks_[a], tracks_[b], third)), variation);
  }

  const std::vector<std::string>& labels_;
  const std::vector<Track>& tracks_;
};

/// By how points move: standing still, far away.
void CheckMotion(const std::vector<Track>& tracks, const std::vector<LearnFrame>& frames,
                 std::vector<std::string>* why) {
  std::vector<double> radii, distances;
  radii.reserve(tracks.size());
  for (const Track& track : tracks) radii.push_back(RadiusOf(track));
  const bool is_moving = Median(radii) > ComputedTuning::kMoving;
  Track middle(3, static_cast<Eigen::Index>(frames.size()));
  for (std::size_t k = 0; k < frames.size(); ++k) {
    for (int i = 0; i < 3; ++i) {
      const Eigen::VectorXd row = frames[k].z.row(i).transpose();
      middle(i, static_cast<Eigen::Index>(k)) = Median(std::vector<double>(row.begin(), row.end()));
    }
  }
  for (std::size_t l = 0; l < tracks.size(); ++l) {
    if (!(*why)[l].empty() || !std::isfinite(radii[l])) continue;
    const Eigen::VectorXd away = (tracks[l] - middle).colwise().norm();
    if (is_moving && radii[l] < ComputedTuning::kStill) {
      (*why)[l] = "stands still while the others move";
    } else if (Median(std::vector<double>(away.begin(), away.end())) > ComputedTuning::kFarAway) {
      (*why)[l] = fmt::format("more than {:g} m away from the others", ComputedTuning::kFarAway);
    }
  }
}

}  // namespace

std::vector<std::string> WhyNoMarkers(const std::vector<std::string>& labels,
                                      const std::vector<LearnFrame>& frames) {
  std::vector<std::string> why(labels.size());
  for (std::size_t l = 0; l < labels.size(); ++l) why[l] = WhyByName(labels[l]);
  const std::vector<Track> tracks = TracksOf(labels.size(), frames);
  CheckMotion(tracks, frames, &why);
  const Functions functions(labels, tracks);
  std::vector<int> others;
  for (int l = 0; l < static_cast<int>(labels.size()); ++l) {
    if (!why[l].empty()) continue;
    const auto same = std::find_if(others.begin(), others.end(), [&](int other) {
      const Eigen::VectorXd apart = (tracks[l] - tracks[other]).colwise().norm();
      const auto seen = apart.array().isFinite().count();
      return seen >= ComputedTuning::kFewestCompared &&
             Max(std::vector<double>(apart.begin(), apart.end())) < ComputedTuning::kExactly;
    });
    if (same != others.end()) {
      why[l] = fmt::format("always where {} is", labels[*same]);
    } else {
      others.push_back(l);
    }
  }
  for (const int l : std::vector<int>(others)) {
    std::erase(others, l);
    why[l] = functions.WhyFunction(l, others);
    if (why[l].empty()) others.push_back(l);
    std::sort(others.begin(), others.end());
  }
  return why;
}

}  // namespace mmm_converter
