// SPDX-License-Identifier: MIT
#include "common/motion/held_markers.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

namespace mmm_converter {
namespace {

constexpr int kFewestFrames = 5;       // in which a marker stands
constexpr double kMovingShare = 0.2;   // of the other markers
constexpr double kShortestWay = 0.02;  // [m] of a jump, and by which others leave
constexpr double kJump = 3;            // times the largest of usual steps
constexpr std::size_t kPartners = 3;
constexpr double kLoosest = 0.03;    // [m] deviation of a distance that still tells of a link
constexpr double kLeaves = 4;        // times that deviation
constexpr int kFewestTogether = 10;  // frames that tell a distance
constexpr int kMostCompared = 200;   // frames
constexpr int kMostLabels = 512;     // that a marker is compared with

struct Partner {
  int label;
  double distance, deviation;  // [m]
};

class Finder {
 public:
  explicit Finder(const MarkerSequence& markers)
      : markers_(markers),
        labels_(static_cast<std::size_t>(markers.num_labels())),
        stands_(labels_ * static_cast<std::size_t>(markers.num_frames())),
        partners_(labels_),
        usual_steps_(labels_) {}

  std::vector<HeldStretch> Run() {
    std::vector<HeldStretch> runs;
    for (int i = 0; i < markers_.num_labels(); ++i) AddRuns(i, &runs);
    std::vector<HeldStretch> held;
    if (runs.empty()) return held;
    CountMoving();
    for (const HeldStretch& run : runs) {
      if (OthersMove(run) && (Jumps(run) || IsLeft(run))) {
        held.push_back({run.label, run.begin + 1, run.end});
      }
    }
    return held;
  }

 private:
  Eigen::Vector3d At(int k, int label) const { return markers_.frame(k).col(label); }
  bool Stays(int k, int label) const { return At(k, label) == At(k - 1, label); }
  std::size_t Place(int k, int label) const {
    return static_cast<std::size_t>(k) * labels_ + static_cast<std::size_t>(label);
  }
  bool IsInRun(int k, int label) const { return stands_[Place(k, label)]; }

  /// From the first frame with a value to behind the last one with the same.
  void AddRuns(int label, std::vector<HeldStretch>* runs) {
    for (int k = 1; k < markers_.num_frames(); ++k) {
      const int first = k - 1;
      while (k < markers_.num_frames() && Stays(k, label)) ++k;
      if (k - first < kFewestFrames) continue;
      runs->push_back({LabelIx(label), first, k});
      for (int i = first + 1; i < k; ++i) stands_[Place(i, label)] = true;
    }
  }

  void CountMoving() {
    moving_.assign(static_cast<std::size_t>(markers_.num_frames()), 0);
    seen_ = moving_;
    for (int k = 1; k < markers_.num_frames(); ++k) {
      for (int i = 0; i < markers_.num_labels(); ++i) {
        const bool is_seen = IsSeen(At(k, i)) && IsSeen(At(k - 1, i));
        seen_[static_cast<std::size_t>(k)] += is_seen;
        moving_[static_cast<std::size_t>(k)] += is_seen && !Stays(k, i);
      }
    }
  }

  bool OthersMove(const HeldStretch& run) const {
    double moving = 0;
    double others = 0;
    for (int k = run.begin + 1; k < run.end; ++k) {
      moving += moving_[static_cast<std::size_t>(k)];
      others += seen_[static_cast<std::size_t>(k)] - 1;
    }
    return others > 0 && moving >= kMovingShare * others;
  }

  /// The largest step from a frame to the next, but for one in a hundred; without those to and from
  /// where the marker stays.
  double UsualStep(int label) {
    std::optional<double>& usual = usual_steps_[static_cast<std::size_t>(label)];
    if (usual) return *usual;
    std::vector<double> steps;
    for (int k = 1; k < markers_.num_frames(); ++k) {
      const double step = (At(k, label) - At(k - 1, label)).norm();
      if (step > 0 && !IsInRun(k - 1, label)) steps.push_back(step);
    }
    usual = 0;
    if (steps.empty()) return 0;
    const auto most = steps.begin() + static_cast<std::ptrdiff_t>((steps.size() - 1) * 99 / 100);
    std::nth_element(steps.begin(), most, steps.end());
    usual = *most;
    return *most;
  }

  bool Jumps(const HeldStretch& run) {
    if (run.end >= markers_.num_frames()) return false;
    const double jump = (At(run.end, run.label) - At(run.begin, run.label)).norm();
    return jump > kShortestWay && jump > kJump * UsualStep(run.label);
  }

  /// Those that keep their distance best where neither stands.
  const std::vector<Partner>& PartnersOf(int label) {
    std::optional<std::vector<Partner>>& known = partners_[static_cast<std::size_t>(label)];
    if (known) return *known;
    std::vector<Partner> partners;
    const int stride = std::max(1, markers_.num_frames() / kMostCompared);
    for (int j = 0; j < std::min(markers_.num_labels(), kMostLabels); ++j) {
      double sum = 0;
      double squares = 0;
      int count = 0;
      for (int k = 0; k < markers_.num_frames() && j != label; k += stride) {
        const double distance = (At(k, label) - At(k, j)).norm();
        if (!std::isfinite(distance) || IsInRun(k, label) || IsInRun(k, j)) continue;
        sum += distance;
        squares += distance * distance;
        ++count;
      }
      if (count < kFewestTogether) continue;
      const double mean = sum / count;
      const double deviation = std::sqrt(std::max(0.0, squares / count - mean * mean));
      if (deviation <= kLoosest) partners.push_back({j, mean, deviation});
    }
    std::stable_sort(partners.begin(), partners.end(),
                     [](const Partner& a, const Partner& b) { return a.deviation < b.deviation; });
    partners.resize(std::min(partners.size(), kPartners));
    return known.emplace(std::move(partners));
  }

  bool IsLeft(const HeldStretch& run) {
    int together = 0;
    int apart = 0;
    for (const Partner& partner : PartnersOf(run.label)) {
      const double bound = std::max(kShortestWay, kLeaves * partner.deviation);
      for (int k = run.begin + 1; k < run.end; ++k) {
        if (!IsSeen(At(k, partner.label)) || IsInRun(k, partner.label)) continue;
        const double distance = (At(k, run.label) - At(k, partner.label)).norm();
        ++together;
        apart += std::abs(distance - partner.distance) > bound;
      }
    }
    return together > 0 && 2 * apart > together;
  }

  const MarkerSequence& markers_;
  std::size_t labels_;
  std::vector<bool> stands_;        // frame-major: has the value of the frame before, in a run
  std::vector<int> moving_, seen_;  // markers, of each frame and the one before it
  std::vector<std::optional<std::vector<Partner>>> partners_;
  std::vector<std::optional<double>> usual_steps_;
};

}  // namespace

std::vector<HeldStretch> FindHeldMarkers(const MarkerSequence& markers) {
  return Finder(markers).Run();
}

}  // namespace mmm_converter
