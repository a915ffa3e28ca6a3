// SPDX-License-Identifier: MIT
#include "common/contacts/person_mass.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/math/statistics.h"

namespace mmm_converter {
namespace {

constexpr double kGravity = 9.81;           // [m/s^2]
constexpr double kStandsStill = 0.02;       // of the load: its standard deviation
constexpr double kShortestStanding = 1;     // [s]
constexpr double kDeviationOfAStep = 0.02;  // of the mass, by a single step of a walk
constexpr double kLeastMass = 5;            // [kg] less is a plate that shakes
constexpr double kUpright = 0.85;  // of the largest height of the body: who sits is on a chair, too
constexpr double kAround = 0.05;   // [s] before and after a time that tell a speed

struct Interval {
  double begin = 0, end = 0;  // [s]
};

/// Of all plates, upwards [N]; NaN where one has no number.
double TotalLoad(const RecordedForces& forces, int sample) {
  double load = 0;
  for (const PlateForces& plate : forces.plates) load += plate.Load(sample);
  return load;
}

bool AreAllOnPlates(const Contacts& contacts, const Interval& interval) {
  bool is_any = false;
  for (const FootContact& one : contacts.contacts) {
    const bool is_there =
        one.begin.value_or(-HUGE_VAL) < interval.end && one.end.value_or(HUGE_VAL) > interval.begin;
    if (is_there && one.plates.empty()) return false;
    is_any |= is_there;
  }
  for (const PlateLoad& load : contacts.loads) {
    const bool is_there = load.begin < interval.end && load.end > interval.begin;
    if (is_there && (load.is_part_of_foot || load.bearer == Bearer::kUnknown)) return false;
  }
  return is_any;
}

/// The mean height of the body within [begin, end) [m].
double HeightIn(const FootMotion& motion, double begin, double end) {
  const int first = motion.frame(begin);
  const int count = std::max(1, motion.frame(end) - first);
  return motion.body.row(2).segment(first, count).mean();
}

/// By how much faster the body moves upwards at the end of an interval [m/s].
double FasterUpwards(const FootMotion& motion, const Interval& interval) {
  if (motion.body.cols() == 0) return 0;
  const auto speed = [&](double time) {
    return (HeightIn(motion, time, time + kAround) - HeightIn(motion, time - kAround, time)) /
           kAround;
  };
  return speed(interval.end) - speed(interval.begin);
}

bool IsUpright(const FootMotion& motion, const Interval& interval) {
  if (motion.body.cols() == 0) return true;
  return HeightIn(motion, interval.begin, interval.end) >= kUpright * motion.body.row(2).maxCoeff();
}

std::vector<Interval> StepsOf(const Contacts& contacts) {
  std::vector<const FootContact*> steps;
  for (const FootContact& one : contacts.contacts) {
    if (one.begin && one.end) steps.push_back(&one);
  }
  std::sort(steps.begin(), steps.end(),
            [](const FootContact* a, const FootContact* b) { return *a->begin < *b->begin; });
  std::vector<Interval> intervals;
  for (std::size_t i = 1; i < steps.size(); ++i) {
    if (steps[i]->side == steps[i - 1]->side) continue;
    const Interval one = {(*steps[i - 1]->begin + *steps[i - 1]->end) / 2,
                          (*steps[i]->begin + *steps[i]->end) / 2};
    if (one.end > one.begin && AreAllOnPlates(contacts, one)) intervals.push_back(one);
  }
  return intervals;
}

struct Load {
  double mean = 0, deviation = 0;
};

std::optional<Load> LoadOf(const RecordedForces& forces, const Interval& interval) {
  const auto samples = static_cast<double>(forces.plates[0].force.cols());
  const auto sample = [&](double time) {
    return static_cast<int>(
        std::clamp(std::round((time - forces.first_time) * forces.rate), 0.0, samples));
  };
  const int begin = sample(interval.begin);
  const int end = sample(interval.end);
  if (end - begin < 2) return std::nullopt;
  double sum = 0;
  double squares = 0;
  for (int k = begin; k < end; ++k) {
    const double load = TotalLoad(forces, k);
    sum += load;
    squares += load * load;
  }
  Load load;
  load.mean = sum / (end - begin);
  load.deviation = std::sqrt(std::max(0.0, squares / (end - begin) - load.mean * load.mean));
  return std::isfinite(load.mean) ? std::optional(load) : std::nullopt;
}

/// Seconds of the recording in which the load is steady.
std::vector<double> StandingLoads(const Contacts& contacts, const RecordedForces& forces,
                                  const FootMotion& motion) {
  std::vector<double> loads;
  const double seconds = static_cast<double>(forces.plates[0].force.cols()) / forces.rate;
  for (int i = 0; (i + 1) * kShortestStanding <= seconds; ++i) {
    const Interval one = {forces.first_time + i * kShortestStanding,
                          forces.first_time + (i + 1) * kShortestStanding};
    if (!AreAllOnPlates(contacts, one) || !IsUpright(motion, one)) continue;
    const auto load = LoadOf(forces, one);
    if (load && load->deviation < kStandsStill * load->mean) loads.push_back(load->mean);
  }
  return loads;
}

}  // namespace

std::optional<MassByPlates> EstimateMass(const Contacts& contacts, const RecordedForces& forces,
                                         const FootMotion& motion) {
  if (forces.plates.empty()) return std::nullopt;
  std::vector<double> masses;
  for (const double load : StandingLoads(contacts, forces, motion)) {
    masses.push_back(load / kGravity);
  }
  for (const Interval& step : StepsOf(contacts)) {
    const auto load = LoadOf(forces, step);
    const double faster = FasterUpwards(motion, step) / (step.end - step.begin);
    if (load) masses.push_back(load->mean / (kGravity + faster));
  }
  std::erase_if(masses, [](double mass) { return mass < kLeastMass; });
  if (masses.empty()) return std::nullopt;
  MassByPlates found;
  found.mass = Median(masses);
  found.intervals = static_cast<int>(masses.size());
  double squares = 0;
  for (const double mass : masses) squares += (mass - found.mass) * (mass - found.mass);
  const double spread = std::sqrt(squares / static_cast<double>(masses.size()));
  const double of_steps = kDeviationOfAStep * found.mass;
  found.deviation = std::hypot(spread, of_steps) / std::sqrt(static_cast<double>(masses.size()));
  return found;
}

}  // namespace mmm_converter
