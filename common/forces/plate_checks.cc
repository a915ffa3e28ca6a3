// SPDX-License-Identifier: MIT
#include "common/forces/plate_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
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
constexpr double kSubtracted = 25;     // [N] 21 of OpenSim's sample are kept, as OpenSim keeps them
constexpr double kUnloadedPiece = 0.5;  // [s] in which a level hardly drifts
constexpr double kStandsStill = 0.02;   // [s] noise alone moves a channel within this time
constexpr double kStandsLong = 0.1;     // [s] one steep end is enough
constexpr double kSteep = 2;            // of the extreme, each second: no smooth summit is so steep
constexpr double kLeastRange = 100;     // [N] of a channel of forces
constexpr double kLeastMomentRange = 10;  // [N m]
constexpr double kFlat = 0.002;           // of the extreme: noise of a converter at its end
constexpr int kSlopeSamples = 3;          // beside a flat top

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

/// What no channel of a plate ends at, in the channel's unit.
double LeastRange(const ForcePlate& plate, Eigen::Index row) {
  const bool is_cop = plate.type == PlateType::kForcesAndCop && row >= 3;
  if (is_cop || plate.type == PlateType::kCalibratedChannels) return 0;  // not in newtons
  const bool is_moment = plate.type == PlateType::kForcesAndMoments && row >= 3;
  return is_moment ? kLeastMomentRange / plate.moment_unit : kLeastRange / plate.force_unit;
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

void SubtractUnloaded(double rate, const ForcePlate& plate, Eigen::MatrixXd* channels,
                      Warnings* warnings) {
  PlateForces forces = ForcesOfPlate(plate, *channels);
  const auto level = UnloadedLevel(VerticalForce(forces));
  if (!level) return;
  JudgeLoads(rate, &forces, nullptr);
  const auto around = static_cast<int>(std::lround(kShortest * rate));
  const auto longest = static_cast<int>(std::lround(kUnloadedPiece * rate));
  const auto samples = static_cast<int>(channels->cols());
  std::vector<bool> is_unloaded(static_cast<std::size_t>(samples));
  for (int k = 0; k < samples; ++k) {
    is_unloaded[static_cast<std::size_t>(k)] =
        std::abs(forces.Load(k)) < kContactThreshold && channels->col(k).allFinite();
  }
  for (const LoadInterval& load : forces.loads) {
    const auto from = is_unloaded.begin() + std::max(0, load.begin - around);
    std::fill(from, is_unloaded.begin() + std::min(samples, load.end + around), false);
  }
  std::vector<std::pair<double, Eigen::VectorXd>> pieces;  // the middle sample, and the mean
  for (int k = 0; k < samples;) {
    int end = k;
    while (end < samples && end - k < longest && is_unloaded[static_cast<std::size_t>(end)]) ++end;
    if (end - k >= std::max(around, 1)) {
      pieces.emplace_back((k + end - 1) / 2.0, channels->middleCols(k, end - k).rowwise().mean());
    }
    k = std::max(end, k + 1);
  }
  if (pieces.empty()) return;
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(channels->rows());
  for (const auto& [middle, levels] : pieces) mean += levels / static_cast<double>(pieces.size());
  const PlateForces unloaded = ForcesOfPlate(plate, mean);
  if (std::max(std::abs(*level), unloaded.force.norm()) <= kSubtracted) return;
  std::size_t next = 0;
  for (int k = 0; k < samples; ++k) {
    while (next < pieces.size() && pieces[next].first < k) ++next;
    const auto& after = pieces[std::min(next, pieces.size() - 1)];
    const auto& before = pieces[next == 0 ? 0 : next - 1];
    const double span = after.first - before.first;
    const double share = span > 0 ? (k - before.first) / span : 0;
    channels->col(k) -= (1 - share) * before.second + share * after.second;
  }
  Warn(warnings,
       fmt::format(
           "force plate {}: {:.0f} N{} while nobody is on it; this is taken away from all of "
           "its channels",
           plate.number, *level,
           unloaded.moment.allFinite() ? fmt::format(" upwards, {:.0f} N and {:.1f} N m in all",
                                                     unloaded.force.norm(), unloaded.moment.norm())
                                       : ""));
}

void FindClipped(double rate, double first_time, PlateForces* forces, Warnings* warnings) {
  constexpr const char* kNames[] = {"Fx", "Fy", "Fz", "Mx", "My", "Mz"};
  const Eigen::MatrixXd& channels = forces->channels;
  const auto shortest = std::max(5, static_cast<int>(std::lround(kStandsStill * rate)));
  for (Eigen::Index row = 0; row < channels.rows(); ++row) {
    const auto v = channels.row(row);
    double extreme = 0;
    for (const double one : v) {
      if (std::isfinite(one)) extreme = std::max(extreme, std::abs(one));
    }
    if (extreme < LeastRange(forces->plate, row)) continue;
    const auto is_steep = [&](int from, int to) {
      if (from < 0 || to >= v.size()) return false;
      return std::abs(v[to] - v[from]) / kSlopeSamples * rate > kSteep * extreme;
    };
    std::vector<LoadInterval> found;
    for (const LoadInterval& load : forces->loads) {
      for (int k = load.begin; k < load.end;) {
        int end = k + 1;
        const bool is_extreme = std::abs(v[k]) >= (1 - kFlat) * extreme && extreme > 0;
        while (is_extreme && end < load.end && std::abs(v[end] - v[k]) <= 2 * kFlat * extreme) {
          ++end;
        }
        const int steep_ends =
            is_steep(k - 1 - kSlopeSamples, k - 1) + is_steep(end, end + kSlopeSamples);
        if (is_extreme && end - k >= shortest &&
            steep_ends >= (end - k >= kStandsLong * rate ? 1 : 2)) {
          found.push_back({k, end});
        }
        k = end;
      }
    }
    if (found.empty()) continue;
    std::string times;
    for (const LoadInterval& one : found) {
      times += fmt::format("{}{:.2f} to {:.2f} s", times.empty() ? "" : ", ",
                           first_time + one.begin / rate, first_time + one.end / rate);
    }
    const bool is_named = forces->plate.type == PlateType::kForcesAndMoments;
    Warn(warnings,
         fmt::format("force plate {}: {} is saturated, it stands at {:.6g} from {}; what the plate "
                     "tells then is wrong",
                     forces->plate.number,
                     is_named
                         ? kNames[row]
                         : fmt::format("channel {}",
                                       forces->plate.channels[static_cast<std::size_t>(row)] + 1),
                     v[found.front().begin], times));
    forces->clipped.insert(forces->clipped.end(), found.begin(), found.end());
  }
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

void LeaveOutStopped(double rate, double first_time, const ForcePlate& plate,
                     Eigen::MatrixXd* channels, Warnings* warnings) {
  Eigen::Index begin = channels->cols() - 1;
  while (begin > 0 && channels->col(begin) == channels->col(begin - 1)) --begin;
  const Eigen::Index still = channels->cols() - begin;
  if (begin <= 0 || static_cast<double>(still) < kStandsLong * rate) return;
  const Eigen::VectorXd vertical = VerticalForce(ForcesOfPlate(plate, *channels));
  const double level = UnloadedLevel(vertical.head(begin)).value_or(0);
  if (!(std::abs(vertical[begin] - level) > kSurelyLoaded)) return;
  channels->rightCols(still).setConstant(kNaN);
  Warn(warnings,
       fmt::format("force plate {}: none of its channels changes from {:.2f} s on, which "
                   "makes {:.0f} N: it is not measured from there",
                   plate.number, first_time + static_cast<double>(begin) / rate, vertical[begin]));
}

std::vector<int> StillShears(const ForcePlate& plate, const Eigen::MatrixXd& channels) {
  std::vector<int> still;
  if (plate.type == PlateType::kEightForces || channels.cols() < 2) return still;
  for (const int row : {0, 1}) {
    if (channels.row(row).minCoeff() == channels.row(row).maxCoeff()) still.push_back(row);
  }
  return still;
}

void LeaveOutStill(const std::vector<int>& shears, PlateForces* forces, Warnings* warnings) {
  if (shears.empty() || forces->loads.empty()) return;
  forces->moment.setConstant(kNaN);
  for (const int row : shears) {
    const bool is_raw = forces->plate.type == PlateType::kCalibratedChannels;
    const std::string name = is_raw     ? ""
                             : row == 0 ? "horizontal force Fx, "
                                        : "horizontal force Fy, ";
    Warn(
        warnings,
        fmt::format("force plate {}: its {}channel {} never changes, also while somebody is on it: "
                    "it is not measured, and no joint moments are told from this plate",
                    forces->plate.number, name,
                    forces->plate.channels[static_cast<std::size_t>(row)] + 1));
  }
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
