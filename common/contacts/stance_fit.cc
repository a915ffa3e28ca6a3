// SPDX-License-Identifier: MIT
#include "common/contacts/stance_fit.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

#include "common/forces/plate_checks.h"

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
constexpr double kSlant = 0.03;  // horizontal by vertical force, root mean square, that tells a way

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

StanceFeet::StanceFeet(const FootMotion& motion, const KnownLegs& known,
                       const RecordedForces& forces)
    : motion_(motion), forces_(forces), slow_(FindSlowFeet(motion, forces)) {
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
  double sum = 0, count = 0, with = 0, slants = 0, ways = 0;
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
    with += slant.dot(to_body);
    slants += slant.squaredNorm();
    ways += to_body.squaredNorm();
  }
  if (count == 0) return;
  fit->distances.push_back(sum / count);
  fit->travel = std::min(fit->travel, box.sizes().norm());
  const bool tells_way = std::min(slants, ways) > kSlant * kSlant * count;
  if (tells_way) fit->along = std::min(fit->along, with / std::sqrt(slants * ways));
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
