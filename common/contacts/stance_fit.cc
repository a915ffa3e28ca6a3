// SPDX-License-Identifier: MIT
#include "common/contacts/stance_fit.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

#include "common/forces/plate_checks.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

constexpr double kTellingShare = 0.2;  // of the peak: the centre of pressure of less means little
constexpr double kLoaded = 50;         // [N]
constexpr double kStance = 0.2;        // [s] at least
constexpr double kLifted = 0.05;       // [m] heel above toes, or toes above heel
constexpr double kForefoot = 0.6;      // of the foot's length
constexpr double kHeel = 0.4;
constexpr double kSameTime = 0.12;       // [s] between the ends of a load and of a slow foot
constexpr double kIsThere = 0.4;         // of a load's time
constexpr double kMargin = 0.05;         // [m] around a plate
constexpr double kNearPlate = 0.25;      // [m] above a plate
constexpr double kStandsUpright = 0.75;  // of the largest height of the body above the feet
// Horizontal by vertical force, root mean square, that tells a way, and along one axis alone.
constexpr double kSlant = 0.03;
constexpr double kSlantOfAxis = 0.02;
// Cosine between slants of forces and of the ways to the body along an axis: of 24 stances on right
// plates of 13 files it is -0.11 to 1.
constexpr double kAway = -0.5;
constexpr double kLate = 0.07;    // [s] between loads and feet that stand
constexpr double kPasses = 0.15;  // [m] of the body over a foot, that tells a direction

/// From the part of the foot that is on the ground, horizontally [m].
double DistanceFromSole(const Eigen::Vector3d& heel, const Eigen::Vector3d& toe,
                        const Eigen::Vector3d& p) {
  const Eigen::Vector2d line = (toe - heel).head<2>();
  const Eigen::Vector2d from_heel = (p - heel).head<2>();
  const double lift = heel.z() - toe.z();
  const double from = lift > kLifted ? kForefoot : 0;
  const double to = lift < -kLifted ? kHeel : 1;
  const double length2 = line.squaredNorm();
  const double share = length2 > 0 ? std::clamp(from_heel.dot(line) / length2, from, to) : 0;
  return (from_heel - share * line).norm();
}

bool IsTold(const PlateForces& plate, Eigen::Index sample) {
  return plate.force.col(sample).allFinite() && plate.cop.col(sample).allFinite();
}

}  // namespace

double Fit::Towards() const {
  const double most = kSlant * kSlant * frames;
  if (!(slants.sum() > most && ways.sum() > most)) return 1;
  return with.sum() / std::sqrt(slants.sum() * ways.sum());
}

bool Fit::LeansAway() const {
  const double most = kSlantOfAxis * kSlantOfAxis * frames;
  for (Eigen::Index j = 0; j < with.size(); ++j) {
    if (!(slants[j] > most && ways[j] > most)) continue;
    if (with[j] < kAway * std::sqrt(slants[j] * ways[j])) return true;
  }
  return false;
}

StanceFeet::StanceFeet(const FootMotion& motion, const KnownLegs& known,
                       const RecordedForces& forces)
    : motion_(motion), forces_(forces), slow_(FindSlowFeet(motion)) {
  const auto frames = static_cast<std::size_t>(motion.num_frames());
  shows_.assign(frames, true);
  double highest = 0;
  for (std::size_t k = 0; k < frames; ++k) {
    for (const auto& leg : known) shows_[k] = shows_[k] && (leg.empty() || leg[k]);
    highest = std::max(highest, HeightOf(k));
  }
  for (std::size_t k = 0; k < frames; ++k) {
    shows_[k] = shows_[k] && HeightOf(k) >= kStandsUpright * highest;
  }
}

std::vector<Stance> StanceFeet::StancesOn(const PlateForces& plate, bool is_table) const {
  const Eigen::VectorXd vertical = (plate.plate.R_WP.col(2).transpose() * plate.force).transpose();
  const double level = UnloadedLevel(-vertical).value_or(0);
  double peak = 0;
  for (const double v : vertical) {
    if (std::isfinite(v)) peak = std::max(peak, std::abs(-v - level));
  }
  const double least = std::max(kTellingShare * peak, kLoaded);
  const auto is_loaded = [&](Eigen::Index i) { return std::abs(-vertical[i] - level) >= least; };
  std::vector<Stance> stances;
  Stance current;
  int begin = -1;
  for (int k = 0; k <= motion_.num_frames(); ++k) {
    const Eigen::Index sample = std::lround((motion_.time(k) - forces_.first_time) * forces_.rate);
    const bool loaded =
        k < motion_.num_frames() && sample >= 0 && sample < vertical.size() && is_loaded(sample);
    if (loaded) {
      if (begin < 0) begin = k;
      if (shows_[static_cast<std::size_t>(k)] && IsTold(plate, sample)) {
        current.frames.push_back(k);
        current.samples.push_back(sample);
      }
      continue;
    }
    const bool is_long = static_cast<double>(current.frames.size()) >= kStance * motion_.rate;
    if (begin >= 0 && is_long && (is_table || IsOfPerson(plate.plate, begin, k))) {
      stances.push_back(std::move(current));
    }
    current = {};
    begin = -1;
  }
  return stances;
}

double StanceFeet::Distance(int frame, const Eigen::Vector3d& p, Bearer bearer) const {
  double least = HUGE_VAL;
  for (const Side side : kSides) {
    if (bearer == Bearer::kLeft && side == Side::kRight) continue;
    if (bearer == Bearer::kRight && side == Side::kLeft) continue;
    const FootPath& foot = motion_.foot(side);
    least = std::min(least, DistanceFromSole(foot.heel.col(frame), foot.toe.col(frame), p));
  }
  return least;
}

void StanceFeet::Measure(const Stance& stance, const Eigen::Matrix3Xd& force,
                         const Eigen::Matrix3Xd& cop, Bearer bearer, Fit* fit) const {
  double sum = 0, count = 0;
  Fit here;
  Eigen::AlignedBox2d box;
  for (std::size_t i = 0; i < stance.frames.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const Eigen::Vector3d f = force.col(k), p = cop.col(k);
    if (!f.allFinite() || !p.allFinite() || f.z() == 0) continue;
    ++count;
    sum += Distance(stance.frames[i], p, bearer);
    fit->vertical += f.z();
    box.extend(p.head<2>());
    if (motion_.body.cols() == 0) continue;
    const Eigen::Vector3d way = motion_.body.col(stance.frames[i]) - p;
    const Eigen::Vector2d slant = f.head<2>() / std::abs(f.z());
    const Eigen::Vector2d to_body = way.head<2>() / std::max(way.z(), 0.1);
    here.with += slant.array() * to_body.array();
    here.slants += slant.array().square();
    here.ways += to_body.array().square();
    ++here.frames;
  }
  if (count == 0) return;
  fit->with += here.with;
  fit->slants += here.slants;
  fit->ways += here.ways;
  fit->frames += here.frames;
  fit->along = std::min(fit->along, here.Towards());
  fit->distances.push_back(sum / count);
  fit->travel = std::min(fit->travel, box.sizes().norm());
  if (const auto advance = Advance(stance, cop)) fit->advances.push_back(*advance);
}

/// From the first to the last third of a stance, and against the foot on which that is.
std::optional<double> StanceFeet::Advance(const Stance& stance, const Eigen::Matrix3Xd& cop) const {
  const auto count = static_cast<Eigen::Index>(stance.frames.size());
  if (motion_.body.cols() == 0 || count < 3) return {};
  const auto middle_of = [&](Side side, int frame) -> Eigen::Vector3d {
    const FootPath& foot = motion_.foot(side);
    return (foot.heel.col(frame) + foot.toe.col(frame)) / 2;
  };
  const Eigen::Index half = count / 2;
  const int mid = stance.frames[static_cast<std::size_t>(half)];
  const Eigen::Vector2d p = cop.col(half).head<2>();
  const auto beside = [&](Side side) { return (middle_of(side, mid).head<2>() - p).norm(); };
  const Side side = beside(Side::kLeft) < beside(Side::kRight) ? Side::kLeft : Side::kRight;
  Eigen::Vector2d of_body(0, 0), of_pressure(0, 0);
  const Eigen::Index third = count / 3;
  for (Eigen::Index i = 0; i < third; ++i) {
    for (const Eigen::Index k : {i, count - 1 - i}) {
      const int frame = stance.frames[static_cast<std::size_t>(k)];
      const double sign = (k == i ? -1.0 : 1.0) / static_cast<double>(third);
      const Eigen::Vector2d foot = middle_of(side, frame).head<2>();
      of_body += sign * (motion_.body.col(frame).head<2>() - foot);
      of_pressure += sign * (cop.col(k).head<2>() - foot);
    }
  }
  if (!of_pressure.allFinite() || !(of_body.norm() > kPasses)) return {};
  return of_pressure.dot(of_body.normalized());
}

std::string StanceFeet::Lateness() const {
  std::vector<double> begins, ends;
  for (const PlateForces& plate : forces_.plates) {
    if (!plate.tells_contact) continue;
    for (const LoadInterval& load : plate.loads) {
      const double begin = (forces_.time(load.begin) - motion_.first_time) * motion_.rate;
      const double end = (forces_.time(load.end) - motion_.first_time) * motion_.rate;
      if (begin < 0 || end > motion_.num_frames()) continue;
      if (!IsOfPerson(plate.plate, static_cast<int>(begin), static_cast<int>(end))) continue;
      const SlowFoot* foot = nullptr;
      double most = 0;
      for (const auto& times : slow_) {
        for (const SlowFoot& one : times) {
          const double common = std::min(one.end, end) - std::max(one.begin, begin);
          if (common <= most) continue;
          most = common;
          foot = &one;
        }
      }
      if (foot == nullptr) continue;
      begins.push_back((begin - foot->begin) / motion_.rate);
      ends.push_back((end - foot->end) / motion_.rate);
    }
  }
  if (begins.empty()) return "";
  const double begin = Median(begins), end = Median(ends);
  const bool is_late = std::min(begin, end) > kLate, is_early = std::max(begin, end) < -kLate;
  if (!is_late && !is_early) return "";
  return fmt::format("the plates' forces begin {:.0f} ms and end {:.0f} ms {} than the feet stand",
                     kMillimetres * std::abs(begin), kMillimetres * std::abs(end),
                     is_late ? "later" : "earlier");
}

double StanceFeet::HeightOf(std::size_t frame) const {
  if (motion_.body.cols() == 0) return 1;
  const auto k = static_cast<Eigen::Index>(frame);
  double lowest = HUGE_VAL;
  for (const FootPath& foot : motion_.feet) {
    lowest = std::min({lowest, foot.heel(2, k), foot.toe(2, k)});
  }
  return motion_.body(2, k) - lowest;
}

bool StanceFeet::IsOfPerson(const ForcePlate& plate, int begin, int end) const {
  for (const auto& times : slow_) {
    for (const SlowFoot& one : times) {
      const double most = kSameTime * motion_.rate;
      if (std::abs(one.begin - begin) < most && std::abs(one.end - end) < most) return true;
    }
  }
  ForcePlate wide = plate;
  wide.half_size.array() += kMargin;
  int there = 0;
  for (int k = begin; k < end; ++k) {
    there += std::any_of(kSides.begin(), kSides.end(), [&](Side side) {
      const Eigen::Vector3d middle =
          (motion_.foot(side).heel.col(k) + motion_.foot(side).toe.col(k)) / 2;
      return IsOver(wide, middle) && middle.z() < plate.p_WP.z() + kNearPlate;
    });
  }
  return there > kIsThere * (end - begin);
}

}  // namespace mmm_converter
