// SPDX-License-Identifier: MIT
#include "common/retarget/belt.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/math/statistics.h"

namespace mmm_converter {
namespace {

using Eigen::Vector3d;

constexpr double kFlatHeight = 0.04;  // [m] of both ends
constexpr double kStandsShare = 25;   // [%] of heights below what is about the floor
constexpr double kTurns = 0.3;        // [m/s] of one end by the other, of a foot that lies flat
constexpr double kSlowest = 0.2;      // [m/s] of a belt
constexpr double kAlike = 0.15;       // of its speed, by which feet on it differ
constexpr double kMostAlike = 0.7;    // share of what lies flat that is alike
constexpr double kStays = 0.2;        // of its speed, at which the person may go on
constexpr double kLeastTime = 1;      // [s]
constexpr double kLeastFlat = 0.1;    // of the time, of one foot
constexpr double kFlatTime = 0.4;     // [s] that feet have to lie flat
constexpr double kRemembers = 0.4;    // [s] of these
constexpr double kHipsRemember = 1;   // [s]: a stride

}  // namespace

Vector3d FindBelt(const HumanMotion& motion) {
  const int frames = motion.num_frames();
  if (frames < kLeastTime * motion.rate) return Vector3d::Zero();
  std::vector<double> along_x, along_y;
  for (std::size_t i = 0; i < 2; ++i) {
    const auto level = [&](const Eigen::Matrix3Xd& path) {
      const Eigen::VectorXd heights = path.row(2).transpose();
      return Percentile({heights.data(), static_cast<std::size_t>(frames)}, kStandsShare);
    };
    const double heel_level = level(motion.heels[i]), toe_level = level(motion.toes[i]);
    for (int k = 1; k + 1 < frames; ++k) {
      const Vector3d heel = (motion.heels[i].col(k + 1) - motion.heels[i].col(k - 1));
      const Vector3d toe = (motion.toes[i].col(k + 1) - motion.toes[i].col(k - 1));
      const bool is_flat = motion.heels[i](2, k) < heel_level + kFlatHeight &&
                           motion.toes[i](2, k) < toe_level + kFlatHeight &&
                           (heel - toe).norm() * 0.5 * motion.rate < kTurns;
      if (!is_flat) continue;
      along_x.push_back(0.25 * motion.rate * (heel + toe).x());
      along_y.push_back(0.25 * motion.rate * (heel + toe).y());
    }
  }
  if (static_cast<double>(along_x.size()) < kLeastFlat * frames) return Vector3d::Zero();
  const Vector3d belt(Median(along_x), Median(along_y), 0);
  const double speed = belt.norm();
  if (speed < kSlowest) return Vector3d::Zero();
  double alike = 0;
  for (std::size_t n = 0; n < along_x.size(); ++n) {
    const double off = std::hypot(along_x[n] - belt.x(), along_y[n] - belt.y());
    if (off < kAlike * speed) ++alike;
  }
  if (alike < kMostAlike * static_cast<double>(along_x.size())) return Vector3d::Zero();
  const Vector3d way = motion.bodies.back().mid_hip - motion.bodies.front().mid_hip;
  const double going = way.head<2>().norm() * motion.rate / (frames - 1);
  return going < kStays * speed ? belt : Vector3d(Vector3d::Zero());
}

void MoveAgainst(const Vector3d& velocity, HumanMotion* motion) {
  for (int k = 0; k < motion->num_frames(); ++k) {
    const Vector3d way = k / motion->rate * velocity;
    BodyPosture& body = motion->bodies[static_cast<std::size_t>(k)];
    body.mid_hip -= way;
    for (auto* limbs : {&body.legs, &body.arms}) {
      for (LimbPosture& limb : *limbs) {
        for (Vector3d* centre : {&limb.proximal, &limb.middle, &limb.distal}) *centre -= way;
      }
    }
    for (std::size_t i = 0; i < 2; ++i) {
      motion->heels[i].col(k) -= way;
      motion->toes[i].col(k) -= way;
    }
  }
}

void BeltWatch::Take(const std::array<std::array<PointWatch, 2>, 2>& feet, const Vector3d& hips,
                     double dt) {
  if (has_hips_) {
    const Vector3d now = (hips - hips_) / dt + velocity_;
    hips_velocity_ += std::min(1.0, dt / kHipsRemember) * (now - hips_velocity_);
  }
  hips_ = hips;
  has_hips_ = true;
  for (const auto& [heel, toe] : feet) {
    const bool is_flat = heel.height() < kFlatHeight && toe.height() < kFlatHeight &&
                         (heel.velocity() - toe.velocity()).norm() < kTurns &&
                         std::abs(heel.velocity().z() + toe.velocity().z()) < kTurns;
    if (!is_flat) continue;
    Vector3d now = 0.5 * (heel.velocity() + toe.velocity()) + velocity_;
    now.z() = 0;
    const double part = std::min(1.0, dt / std::min(kRemembers, flat_for_ + dt));
    spread_ += part * ((now - flat_).norm() - spread_);
    flat_ += part * (now - flat_);
    flat_for_ += dt;
  }
  const double speed = flat_.norm();
  const bool is_belt = flat_for_ > kFlatTime && speed > kSlowest && spread_ < kAlike * speed &&
                       hips_velocity_.head<2>().norm() < kStays * speed;
  const bool is_floor = speed < 0.5 * kSlowest;
  if (is_belt) velocity_ = flat_;
  if (is_floor) velocity_.setZero();
}

}  // namespace mmm_converter
