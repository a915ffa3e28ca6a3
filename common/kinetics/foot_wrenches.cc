// SPDX-License-Identifier: MIT
#include "common/kinetics/foot_wrenches.h"

#include <algorithm>
#include <cmath>

#include "common/motion/low_pass.h"

namespace mmm_converter {
namespace {

/// Frames in which the feet's wrenches are not known.
class UnknownTimes {
 public:
  UnknownTimes(const FrameTimes& times, double reach, FootWrenches* feet)
      : times_(times), reach_(reach), feet_(*feet) {}

  void Mark(std::size_t foot, double begin, double end) {
    const auto frame = [&](double time) {
      return std::clamp((time - times_.first_time) * times_.rate, -1.0,
                        static_cast<double>(times_.count));
    };
    const auto last = static_cast<int>(std::floor(frame(end + reach_)));
    for (int k = std::max(0, static_cast<int>(std::ceil(frame(begin - reach_))));
         k <= std::min(last, times_.count - 1); ++k) {
      feet_[foot].is_known[static_cast<std::size_t>(k)] = false;
    }
  }

  void MarkBoth(double begin, double end) {
    for (std::size_t foot = 0; foot < feet_.size(); ++foot) Mark(foot, begin, end);
  }

 private:
  FrameTimes times_;
  double reach_;
  FootWrenches& feet_;
};

/// Adds the plate's wrench in one load; false: of a sample it is not known.
bool AddLoad(const PlateLoad& load, const RecordedForces& forces, const FrameTimes& times,
             FootWrench* foot) {
  const PlateForces& plate = forces.plates[load.plate];
  const double samples_a_frame = forces.rate / times.rate;
  const auto sample_of = [&](double frame) {
    const double time = times.first_time + frame / times.rate;
    return static_cast<Eigen::Index>(std::ceil((time - forces.first_time) * forces.rate - 1e-6));
  };
  bool is_known = true;
  for (int k = 0; k < times.count; ++k) {
    Eigen::Index begin = sample_of(k - 0.5), end = sample_of(k + 0.5);
    if (samples_a_frame < 1) end = (begin = sample_of(k - 0.5 / samples_a_frame)) + 1;
    begin = std::clamp<Eigen::Index>(begin, 0, plate.force.cols());
    end = std::clamp<Eigen::Index>(end, begin, plate.force.cols());
    const auto from = std::max<Eigen::Index>(begin, load.samples.begin);
    const auto to = std::min<Eigen::Index>(end, load.samples.end);
    for (Eigen::Index i = from; i < to; ++i) {
      const Eigen::Vector3d force = plate.force.col(i);
      const Eigen::Vector3d moment = plate.moment.col(i) + plate.plate.p_WP.cross(force);
      if (!force.allFinite() || !moment.allFinite() || !plate.cop.col(i).allFinite()) {
        is_known = false;
        continue;
      }
      foot->force.col(k) += force / static_cast<double>(end - begin);
      foot->moment.col(k) += moment / static_cast<double>(end - begin);
    }
  }
  return is_known;
}

/// Where plates have no samples.
void MarkBeyond(const RecordedForces& forces, UnknownTimes* unknown) {
  Eigen::Index samples = forces.plates.empty() ? 0 : forces.plates[0].force.cols();
  for (const PlateForces& one : forces.plates) samples = std::min(samples, one.force.cols());
  const double half = 0.5 / forces.rate;
  unknown->MarkBoth(-HUGE_VAL, forces.first_time - half);
  unknown->MarkBoth(forces.time(static_cast<int>(samples)) - half, HUGE_VAL);
}

}  // namespace

FootWrenches WrenchesOnFeet(const Contacts& contacts, const RecordedForces& forces,
                            const FrameTimes& times, double cutoff) {
  FootWrenches feet;
  for (FootWrench& foot : feet) {
    foot.force = foot.moment = Eigen::Matrix3Xd::Zero(3, times.count);
    foot.is_known.assign(static_cast<std::size_t>(times.count), true);
  }
  UnknownTimes unknown(times, cutoff > 0 ? 0.5 / cutoff : 0, &feet);
  if (!forces.plates.empty()) MarkBeyond(forces, &unknown);
  for (const FootContact& one : contacts.contacts) {
    if (!one.plates.empty()) continue;
    unknown.Mark(static_cast<std::size_t>(one.side), one.begin.value_or(-HUGE_VAL),
                 one.end.value_or(HUGE_VAL));
  }
  for (const PlateLoad& load : contacts.loads) {
    if (load.bearer == Bearer::kBoth || load.bearer == Bearer::kUnknown) {
      unknown.MarkBoth(load.begin, load.end);
      continue;
    }
    const std::size_t foot = load.bearer == Bearer::kLeft ? 0 : 1;
    const bool is_known = AddLoad(load, forces, times, &feet[foot]);
    if (!is_known || load.is_part_of_foot) unknown.Mark(foot, load.begin, load.end);
    if (!load.is_part_of_foot) continue;
    for (const FootContact& one : contacts.contacts) {
      const double begin = one.begin.value_or(-HUGE_VAL), end = one.end.value_or(HUGE_VAL);
      const bool is_its =
          static_cast<std::size_t>(one.side) == foot && begin < load.end && end > load.begin;
      if (is_its) unknown.Mark(foot, begin, end);
    }
  }
  if (!(cutoff > 0)) return feet;
  for (FootWrench& foot : feet) {
    for (Eigen::Matrix3Xd* one : {&foot.force, &foot.moment}) {
      *one = LowPassed(one->transpose(), times.rate, cutoff).transpose();
    }
  }
  return feet;
}

}  // namespace mmm_converter
