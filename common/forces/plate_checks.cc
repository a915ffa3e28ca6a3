// SPDX-License-Identifier: MIT
#include "common/forces/plate_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "common/math/statistics.h"

namespace mmm_converter {
namespace {

constexpr double kFarthestOffset = 150;   // [N] of a plate that nobody stands on
constexpr double kUnloadedShare = 0.03;   // of the samples, at least, to be called seen unloaded
constexpr double kUnloadedSpread = 40;    // [N] stairs shake by 20 to 40
constexpr double kContactThreshold = 20;  // [N] the common one (BTK 10, pyCGM2 50)
constexpr double kSurelyLoaded = 50;      // [N]
constexpr double kShakes = 3;             // standard deviations of what an unloaded plate shows
constexpr double kRobustSpread = 1.4826;  // a normal deviation is so many median ones
constexpr double kLoadedShare = 0.2;   // of the peak: what positions of the pressure are told from
constexpr double kShortest = 0.05;     // [s] of a gap that stays, and of a load
constexpr double kBesidePlate = 0.05;  // [m] a foot's pressure may be told beyond the edge
constexpr double kMostlyOn = 0.5;      // of the loaded samples

/// Whether most of the loaded centre of pressure lies on the plate. Nothing: it is never loaded.
std::optional<bool> IsOnPlate(const PlateForces& forces) {
  const Eigen::VectorXd vertical = VerticalForce(forces);
  const double level = UnloadedLevel(vertical).value_or(0);
  double peak = 0;
  for (const double v : vertical) {
    if (std::isfinite(v)) peak = std::max(peak, std::abs(v - level));
  }
  const double least = std::max(kLoadedShare * peak, kSurelyLoaded);
  const ForcePlate& plate = forces.plate;
  int loaded = 0;
  int on = 0;
  for (Eigen::Index k = 0; k < vertical.size(); ++k) {
    if (!(std::abs(vertical[k] - level) >= least)) continue;
    const Eigen::Vector3d p = plate.R_WP.transpose() * (forces.cop.col(k) - plate.p_WP);
    if (!p.allFinite()) continue;
    ++loaded;
    on += std::abs(p.x()) <= plate.half_size.x() + kBesidePlate &&
          std::abs(p.y()) <= plate.half_size.y() + kBesidePlate;
  }
  if (loaded == 0) return std::nullopt;
  return on > kMostlyOn * loaded;
}

void Negate(PlateForces* forces) {
  forces->force *= -1;
  forces->moment *= -1;
  forces->free_moment *= -1;
  forces->unloaded_level *= -1;
}

/// Above what an unloaded plate shows: stairs shake by 20 to 40 N.
double ThresholdOf(const PlateForces& forces) {
  if (!forces.is_seen_unloaded) return kContactThreshold;
  std::vector<double> distances;
  for (int k = 0; k < static_cast<int>(forces.force.cols()); ++k) {
    const double load = std::abs(forces.Load(k));
    if (load <= kFarthestOffset) distances.push_back(load);
  }
  return std::clamp(kShakes * kRobustSpread * Median(distances), kContactThreshold, kSurelyLoaded);
}

/// Where the load is beyond the threshold; short gaps closed, short loads dropped.
std::vector<LoadInterval> LoadsOf(const PlateForces& forces, double rate) {
  const int shortest = static_cast<int>(std::lround(kShortest * rate));
  std::vector<LoadInterval> loads;
  const int samples = static_cast<int>(forces.force.cols());
  const double threshold = ThresholdOf(forces);
  for (int k = 0; k < samples; ++k) {
    if (!(forces.Load(k) > threshold)) continue;
    if (!loads.empty() && k - loads.back().end < shortest) {
      loads.back().end = k + 1;
    } else {
      loads.push_back({k, k + 1});
    }
  }
  std::erase_if(loads, [&](const LoadInterval& load) { return load.end - load.begin < shortest; });
  return loads;
}

}  // namespace

Eigen::VectorXd VerticalForce(const PlateForces& forces) {
  return -(forces.plate.R_WP.col(2).transpose() * forces.force).transpose();
}

std::optional<double> UnloadedLevel(const Eigen::VectorXd& vertical) {
  std::vector<double> sorted;
  sorted.reserve(static_cast<std::size_t>(vertical.size()));
  for (const double v : vertical) {
    if (std::abs(v) <= kFarthestOffset) sorted.push_back(v);
  }
  const auto count = std::max<std::size_t>(
      2, static_cast<std::size_t>(kUnloadedShare * static_cast<double>(vertical.size())));
  if (sorted.size() < count) return std::nullopt;
  std::sort(sorted.begin(), sorted.end());
  std::size_t best = 0;
  for (std::size_t i = 0; i + count <= sorted.size(); ++i) {
    if (sorted[i + count - 1] - sorted[i] < sorted[best + count - 1] - sorted[best]) best = i;
  }
  if (sorted[best + count - 1] - sorted[best] > kUnloadedSpread) return std::nullopt;
  return Median(std::span(sorted).subspan(best, count));
}

void CorrectUnits(const Eigen::MatrixXd& channels, ForcePlate* plate, Warnings* warnings) {
  if (plate->type != PlateType::kForcesAndMoments) return;
  if (IsOnPlate(ForcesOfPlate(*plate, channels)).value_or(true)) return;
  for (const double unit : {1e-3, 1.0, 1e-2}) {
    if (unit == plate->moment_unit) continue;
    ForcePlate other = *plate;
    other.moment_unit = unit;
    if (!IsOnPlate(ForcesOfPlate(other, channels)).value_or(false)) continue;
    Warn(
        warnings,
        fmt::format("force plate {}: with moments in {:g} N m, as the file says, the pressure lies "
                    "beside the plate; with {:g} N m it lies on it: taken so",
                    plate->number, plate->moment_unit, unit));
    plate->moment_unit = unit;
    return;
  }
}

void CorrectOrigin(const Eigen::MatrixXd& channels, ForcePlate* plate, Warnings* warnings) {
  if (plate->is_origin_sign_known) return;
  if (IsOnPlate(ForcesOfPlate(*plate, channels)).value_or(true)) return;
  ForcePlate other = *plate;
  other.origin *= -1;
  if (!IsOnPlate(ForcesOfPlate(other, channels)).value_or(false)) return;
  Warn(warnings, fmt::format("force plate {}: with ORIGIN as the file says it the pressure lies "
                             "beside the plate; reversed it lies on it: taken so",
                             plate->number));
  *plate = other;
}

void JudgeLoads(double rate, PlateForces* forces, Warnings* warnings) {
  const int number = forces->plate.number;
  const Eigen::VectorXd vertical = VerticalForce(*forces);
  const auto level = UnloadedLevel(vertical);
  forces->is_seen_unloaded = level.has_value();
  forces->unloaded_level = level.value_or(0);
  double up = 0;
  double down = 0;
  for (const double v : vertical) {
    if (!std::isfinite(v)) continue;
    up = std::max(up, v - forces->unloaded_level);
    down = std::max(down, forces->unloaded_level - v);
  }
  if (down > kSurelyLoaded && down > up) {
    if (level && up < kSurelyLoaded) {
      Negate(forces);
      forces->is_reversed = true;
      std::swap(up, down);
      Warn(warnings, fmt::format("force plate {}: every load points down; the forces are those on "
                                 "the plate and are reversed",
                                 number));
    } else {
      forces->tells_contact = false;
      Warn(warnings,
           fmt::format("force plate {}: its forces point down, by up to {:.0f} N{}; no contact is "
                       "told from it",
                       number, down, level ? ", and up" : ", and it is never unloaded"));
    }
  }
  forces->largest_load = up;
  if (level && std::abs(*level) > kContactThreshold / 2) {
    Warn(warnings, fmt::format("force plate {}: {:.0f} N while nobody is on it; the data are kept, "
                               "contacts are counted from there",
                               number, forces->unloaded_level));
  }
  if (forces->tells_contact) forces->loads = LoadsOf(*forces, rate);
}

void LeaveOutSaturated(const Eigen::MatrixXd& channels, PlateForces* forces, Warnings* warnings) {
  if (forces->plate.type != PlateType::kForcesAndMoments || forces->loads.empty()) return;
  for (const int row : {3, 4}) {
    double least = std::numeric_limits<double>::infinity();
    double most = -least;
    int samples = 0;
    for (const LoadInterval& load : forces->loads) {
      const auto part = channels.row(row).segment(load.begin, load.end - load.begin);
      least = std::min(least, part.minCoeff());
      most = std::max(most, part.maxCoeff());
      samples += load.end - load.begin;
    }
    if (samples < 2 || least != most) continue;
    forces->cop.setConstant(kNaN);
    forces->free_moment.setConstant(kNaN);
    Warn(warnings,
         fmt::format("force plate {}: its moment M{} never changes while it is loaded; no "
                     "centre of pressure is told",
                     forces->plate.number, row == 3 ? 'x' : 'y'));
    return;
  }
}

}  // namespace mmm_converter
