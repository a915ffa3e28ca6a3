// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "common/contacts/plate_bearers.h"
#include "common/math/statistics.h"

namespace mmm_converter {

// Distances of the centre of pressure from what a foot has on the ground, means of stances [m]:
// right plates of recorded walks have 5 to 75 mm, with feet half beside them 98; corners in another
// order 100 to 220, other faults more.
inline constexpr double kUnderFoot = 0.06;
inline constexpr double kBesideFoot = 0.09;
inline constexpr double kFarFromFoot = 0.15;
inline constexpr double kRetreat = -0.02;       ///< [m] of the pressure, in the body's direction
inline constexpr double kStillPressure = 1e-3;  ///< [m] what moves less in a stance is not measured

/// Times in which a plate bears somebody: frames of the motion, and the sample of each.
struct Stance {
  std::vector<int> frames;
  std::vector<Eigen::Index> samples;
};

/// How well a reading fits the feet.
struct Fit {
  std::vector<double> distances;  ///< mean of each stance [m]
  double travel = HUGE_VAL;       ///< of the pressure, the least of the stances [m]
  double vertical = 0;            ///< mean force [N]
  double along = 1;               ///< cosine between forces and ways to the body
  /// Of slants of forces with those of the ways to the body, and of each with itself, along x and y
  /// of W: sums over all frames.
  Eigen::Array2d with = {0, 0}, slants = {0, 0}, ways = {0, 0};
  double frames = 0;
  std::vector<double> advances;  ///< of stances over which the body moves: of the pressure with it

  /// As `along`, of all stances; 1: forces are too upright to tell.
  double Towards() const;
  /// Whether forces lean away from the body, along x or y of W alone, too.
  bool LeansAway() const;
  /// Whether the pressure moves through the foot against the body.
  bool Retreats() const { return !advances.empty() && Median(advances) < kRetreat; }

  double mean() const { return Mean(distances); }
  bool IsUp() const { return vertical > 0; }
  bool IsGood() const {
    return !distances.empty() && IsUp() && along > 0 && !LeansAway() && !Retreats() &&
           travel >= kStillPressure && Max(distances) <= kUnderFoot;
  }
};

/// What a person's feet say of plates.
class StanceFeet {
 public:
  /// known: as FitPlatesToFeet. All must outlive it.
  StanceFeet(const FootMotion& motion, const KnownLegs& known, const RecordedForces& forces);

  /// The person's stances on a plate. is_table: all loads are the person's.
  std::vector<Stance> StancesOn(const PlateForces& plate, bool is_table) const;

  /// Adds a stance with these forces and centres of pressure, a column for each of its frames.
  /// bearer: the foot that stands; kUnknown: the nearer one.
  void Measure(const Stance& stance, const Eigen::Matrix3Xd& force, const Eigen::Matrix3Xd& cop,
               Bearer bearer, Fit* fit) const;

  /// How much later than the feet all loads begin and end, in a sentence; empty: they come
  /// together.
  std::string Lateness() const;

 private:
  double Distance(int frame, const Eigen::Vector3d& p, Bearer bearer) const;
  std::optional<double> Advance(const Stance& stance, const Eigen::Matrix3Xd& cop) const;
  double HeightOf(std::size_t frame) const;
  bool IsOfPerson(const ForcePlate& plate, int begin, int end) const;

  const FootMotion& motion_;
  const RecordedForces& forces_;
  SlowFeet slow_;
  std::vector<bool> shows_;  // by frame
};

}  // namespace mmm_converter
