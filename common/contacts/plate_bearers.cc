// SPDX-License-Identifier: MIT
#include "common/contacts/plate_bearers.h"

#include <algorithm>
#include <cmath>

#include "common/math/statistics.h"
#include "common/motion/foot_states.h"
#include "common/support/text.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

constexpr double kLoadedShare = 0.2;   // of the peak: the centre of pressure of less means little
constexpr double kFarthest = 0.2;      // [m] from the line of the foot that bears a plate
constexpr double kAhead = 0.05;        // [m] so much nearer, at least ...
constexpr double kTimesNearer = 2;     // ... and so many times
constexpr double kNearerShare = 0.15;  // of a load's time: the other foot bears it then
constexpr double kStandsThere = 0.25;  // of a load's time: the other foot is on the plate too
// [m] beyond a plate's edge: heels of feet that 20 recordings have on plates are found up to 26
// beside them, tips of toes, which bear little, up to 34; of feet half beside 90 to 164.
constexpr std::array<double, 2> kBeside = {0.03, 0.05};
constexpr double kAtEnds = 0.05;  // [s] of a load

double DistanceFromLine(const Eigen::Vector3d& heel, const Eigen::Vector3d& toe,
                        const Eigen::Vector3d& p) {
  const Eigen::Vector2d line = (toe - heel).head<2>();
  const Eigen::Vector2d from_heel = (p - heel).head<2>();
  const double length2 = line.squaredNorm();
  const double share = length2 > 0 ? std::clamp(from_heel.dot(line) / length2, 0.0, 1.0) : 0;
  return (from_heel - share * line).norm();
}

/// Frames of a load, and the sample of each.
struct LoadedFrames {
  int begin = 0, end = 0;
  const FootMotion& motion;
  const RecordedForces& forces;
  const PlateLoad& load;

  LoadedFrames(const FootMotion& all, const RecordedForces& recorded, const PlateLoad& of)
      : motion(all), forces(recorded), load(of) {
    const auto frame = [&](double time) {
      return std::clamp(std::ceil((time - motion.first_time) * motion.rate), 0.0,
                        static_cast<double>(motion.num_frames()));
    };
    begin = static_cast<int>(frame(load.begin));
    end = static_cast<int>(frame(load.end));
  }
  int SampleOf(int frame) const {
    const double sample = std::round((motion.time(frame) - forces.first_time) * forces.rate);
    return std::clamp(static_cast<int>(sample), load.samples.begin, load.samples.end - 1);
  }
};

/// Horizontal, in the frames that tell it [m].
struct Distances {
  std::array<std::vector<double>, 2> of;

  /// Of the frames in which this foot is the nearer one.
  double ShareOf(Side side) const {
    const auto& own = of[static_cast<std::size_t>(side)];
    const auto& others = of[1 - static_cast<std::size_t>(side)];
    double nearer = 0;
    for (std::size_t i = 0; i < own.size(); ++i) nearer += own[i] < others[i];
    return own.empty() ? 0 : nearer / static_cast<double>(own.size());
  }
};

Distances DistancesOf(const LoadedFrames& frames, const PlateForces& plate) {
  double peak = 0;
  for (int i = frames.load.samples.begin; i < frames.load.samples.end; ++i) {
    const double load = plate.Load(i);
    if (std::isfinite(load)) peak = std::max(peak, load);
  }
  Distances distances;
  for (int k = frames.begin; k < frames.end; ++k) {
    const int sample = frames.SampleOf(k);
    const Eigen::Vector3d cop = plate.cop.col(sample);
    if (!(plate.Load(sample) > kLoadedShare * peak) || !cop.allFinite()) continue;
    for (std::size_t i = 0; i < distances.of.size(); ++i) {
      const FootPath& foot = frames.motion.feet[i];
      distances.of[i].push_back(DistanceFromLine(foot.heel.col(k), foot.toe.col(k), cop));
    }
  }
  return distances;
}

/// Whether a foot stands with its middle on the plate for much of the time of its load.
bool StandsThere(Side side, const LoadedFrames& frames, const SlowFeet& slow,
                 const ForcePlate& plate) {
  const FootPath& foot = frames.motion.foot(side);
  int there = 0;
  for (const SlowFoot& one : slow[static_cast<std::size_t>(side)]) {
    const int begin = std::max(frames.begin, static_cast<int>(std::ceil(one.begin)));
    const int end = std::min(frames.end, static_cast<int>(std::floor(one.end)) + 1);
    for (int k = begin; k < end; ++k) {
      there += IsOver(plate, (foot.heel.col(k) + foot.toe.col(k)) / 2);
    }
  }
  return there > kStandsThere * (frames.end - frames.begin);
}

/// How far p_W lies beyond the plate's edge [m].
double Beyond(const ForcePlate& plate, const Eigen::Vector3d& p_W) {
  const Eigen::Vector3d p = plate.R_WP.transpose() * (p_W - plate.p_WP);
  return (p.head<2>().cwiseAbs() - plate.half_size).maxCoeff();
}

/// Whether another plate bears what is there in the time of a load.
bool IsBorneByAnother(const PlateLoad& load, const Eigen::Vector3d& p_W,
                      const RecordedForces& forces) {
  for (const PlateForces& one : forces.plates) {
    if (&one == &forces.plates[load.plate] || !one.tells_contact || !IsOver(one.plate, p_W)) {
      continue;
    }
    for (const LoadInterval& other : one.loads) {
      if (other.begin < load.samples.end && load.samples.begin < other.end) return true;
    }
  }
  return false;
}

/// Which ends of the foot that bears a plate rest on the ground beside it, and on no other plate,
/// for much of the time of its load.
void FindPart(std::size_t foot, const FootStates& states, const LoadedFrames& frames,
              PlateLoad* load) {
  const RecordedForces& forces = frames.forces;
  const ForcePlate& plate = forces.plates[load->plate].plate;
  if (!(plate.half_size.minCoeff() > 0)) return;
  const bool is_step = std::any_of(
      forces.plates.begin(), forces.plates.end(),
      [&](const auto& one) { return one.plate.p_WP.z() < plate.p_WP.z() - kLowHeight; });
  if (is_step) return;  // beside it is nothing to stand on
  const FootPath& path = frames.motion.feet[foot];
  const auto at_ends = static_cast<int>(std::ceil(kAtEnds * frames.motion.rate));
  for (std::size_t end = 0; end < load->beside.size(); ++end) {
    const PointState& state = end == 0 ? states.heels[foot] : states.toes[foot];
    const Eigen::Matrix3Xd& points = end == 0 ? path.heel : path.toe;
    std::vector<double> beside;
    bool is_first = false, is_last = false;
    for (int k = frames.begin; k < frames.end; ++k) {
      const double beyond = Beyond(plate, points.col(k));
      if (!(beyond > kBeside[end]) || state.height[k] > kLowHeight || states.support(foot, k) > 0 ||
          IsBorneByAnother(*load, points.col(k), forces)) {
        continue;
      }
      is_first |= k < frames.begin + at_ends && state.speed[k] < kComesBelow;
      is_last |= k >= frames.end - at_ends && state.speed[k] < kLeavesAbove;
      if (state.speed[k] < kRestSpeed) beside.push_back(beyond);
    }
    if (static_cast<double>(beside.size()) <= kStandsThere * (frames.end - frames.begin)) continue;
    load->is_part_of_foot = true;
    load->beside[end] = Median(beside);
    load->begins_late |= is_first;
    load->ends_early |= is_last;
  }
}

Bearer Decide(const PlateLoad& load, const Distances& distances, const LoadedFrames& frames,
              const SlowFeet& slow, const PlateForces& plate) {
  const double left = load.distances[0];
  const double right = load.distances[1];
  if (std::isnan(left) || std::isnan(right)) return Bearer::kUnknown;
  const double near = std::min(left, right);
  const double far = std::max(left, right);
  const Side nearest = left < right ? Side::kLeft : Side::kRight;
  const Side other = left < right ? Side::kRight : Side::kLeft;
  if (distances.ShareOf(other) > kNearerShare || StandsThere(other, frames, slow, plate.plate)) {
    return near > kFarthest ? Bearer::kUnknown : Bearer::kBoth;
  }
  if (near > kFarthest) return Bearer::kUnknown;
  if (far < kTimesNearer * near || far < near + kAhead) return Bearer::kBoth;
  return nearest == Side::kLeft ? Bearer::kLeft : Bearer::kRight;
}

}  // namespace

const char* Name(Bearer bearer) {
  constexpr const char* kNames[] = {"left", "right", "both", "unknown"};
  return kNames[static_cast<int>(bearer)];
}

Bearer BearerOfName(const std::string& name) {
  const std::string text = ToLower(name);
  if (text.ends_with("_r") || text.starts_with("r_") || text.find("right") != std::string::npos) {
    return Bearer::kRight;
  }
  if (text.ends_with("_l") || text.starts_with("l_") || text.find("left") != std::string::npos) {
    return Bearer::kLeft;
  }
  return Bearer::kUnknown;
}

bool IsOver(const ForcePlate& plate, const Eigen::Vector3d& p_W) {
  const Eigen::Vector3d p = plate.R_WP.transpose() * (p_W - plate.p_WP);
  return std::abs(p.x()) <= plate.half_size.x() && std::abs(p.y()) <= plate.half_size.y();
}

std::vector<PlateLoad> FindBearers(const FootMotion& motion, const SlowFeet& slow,
                                   const RecordedForces& forces) {
  std::vector<PlateLoad> loads;
  const FootStates states = forces.plates.empty() ? FootStates() : FindFootStates(motion);
  for (std::size_t i = 0; i < forces.plates.size(); ++i) {
    const PlateForces& plate = forces.plates[i];
    if (!plate.tells_contact) continue;
    for (const LoadInterval& samples : plate.loads) {
      PlateLoad load;
      load.plate = i;
      load.samples = samples;
      load.begin = forces.time(samples.begin);
      load.end = forces.time(samples.end);
      const LoadedFrames frames(motion, forces, load);
      const Distances distances = DistancesOf(frames, plate);
      load.distances = {Median(distances.of[0]), Median(distances.of[1])};
      load.bearer = BearerOfName(plate.applied_to);
      if (load.bearer == Bearer::kUnknown) {
        load.bearer = Decide(load, distances, frames, slow, plate);
      }
      if (load.bearer == Bearer::kLeft || load.bearer == Bearer::kRight) {
        FindPart(load.bearer == Bearer::kLeft ? 0 : 1, states, frames, &load);
      }
      loads.push_back(load);
    }
  }
  return loads;
}

}  // namespace mmm_converter
