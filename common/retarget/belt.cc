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
constexpr double kTurns = 0.3;        // [m/s] of one end by the other, of a foot that lies flat
constexpr double kSlowest = 0.2;      // [m/s] of a belt
constexpr double kAlike = 0.15;       // of its speed, by which feet on it differ
constexpr double kStays = 0.2;        // of its speed, at which the person may go on
constexpr double kFlatTime = 0.4;     // [s] that feet have to lie flat
constexpr double kRemembers = 0.4;    // [s] of these
constexpr double kHipsRemember = 1;   // [s]: a stride

}  // namespace

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
