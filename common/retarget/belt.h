// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>

#include "common/retarget/contact_watch.h"
#include "common/retarget/human_body.h"

namespace mmm_converter {

/// As on a floor that goes with that velocity: everything is moved the other way [m/s].
void MoveAgainst(const Eigen::Vector3d& velocity, HumanMotion* motion);

/// The velocity of a treadmill's belt, as FootPath has it, frame by frame: feet that lie flat on it
/// all go one way at one speed, and the person goes nowhere.
class BeltWatch {
 public:
  /// feet: their heels and toes as they move over the belt as it is known until then; hips: their
  /// place, likewise.
  void Take(const std::array<std::array<PointWatch, 2>, 2>& feet, const Eigen::Vector3d& hips,
            double dt);
  /// The next frame is not behind the last one.
  void Interrupt() { has_hips_ = false; }

  const Eigen::Vector3d& velocity() const { return velocity_; }  ///< [m/s]

 private:
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d flat_ = Eigen::Vector3d::Zero();  // of feet that lie flat, in the mean [m/s]
  Eigen::Vector3d hips_ = Eigen::Vector3d::Zero(), hips_velocity_ = Eigen::Vector3d::Zero();
  double spread_ = 0;    // of these [m/s]
  double flat_for_ = 0;  // [s] that feet have lain flat
  bool has_hips_ = false;
};

}  // namespace mmm_converter
