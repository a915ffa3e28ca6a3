// SPDX-License-Identifier: MIT
#include "common/contacts/contacts.h"

#include <algorithm>
#include <cmath>

#include "common/contacts/plate_bearers.h"
#include "common/math/statistics.h"

namespace mmm_converter {
namespace {

constexpr double kJoined = 0.05;     // [s] loads of a foot that are so near are one contact
constexpr double kSameEvent = 0.15;  // [s] between what plates and what speeds say of one event
constexpr double kPlateDeviation = 0.002;  // of a threshold of 20 N
constexpr std::size_t kEnoughEvents = 3;   // to tell a deviation from

/// A time in which a foot stands, by plates or by its speed.
struct Standing {
  double begin = 0, end = 0;
  bool has_begin = true, has_end = true;
  std::vector<int> plates;
  bool begins_late = false, ends_early = false;  // PlateLoad
  double slowing = 0, speeding = 0;              // SlowFoot [s]
};

std::vector<Standing> OnPlates(Side side, const std::vector<PlateLoad>& loads,
                               const RecordedForces& forces) {
  const Bearer bearer = side == Side::kLeft ? Bearer::kLeft : Bearer::kRight;
  std::vector<Standing> standings;
  for (const PlateLoad& load : loads) {
    if (load.bearer != bearer) continue;
    const PlateForces& plate = forces.plates[load.plate];
    standings.push_back(
        {load.begin,
         load.end,
         load.samples.begin > 0,
         load.samples.end < plate.force.cols() && plate.force.col(load.samples.end).allFinite(),
         {plate.plate.number},
         load.begins_late,
         load.ends_early});
  }
  std::sort(standings.begin(), standings.end(),
            [](const Standing& a, const Standing& b) { return a.begin < b.begin; });
  std::vector<Standing> joined;
  for (Standing& one : standings) {
    if (joined.empty() || one.begin - joined.back().end >= kJoined) {
      joined.push_back(std::move(one));
      continue;
    }
    Standing& last = joined.back();
    if (one.end > last.end) {
      last.end = one.end;
      last.has_end = one.has_end;
      last.ends_early = one.ends_early;
    }
    last.plates.push_back(one.plates[0]);
  }
  return joined;
}

std::vector<Standing> BySpeed(const FootMotion& motion, const std::vector<SlowFoot>& slow) {
  std::vector<Standing> standings;
  standings.reserve(slow.size());
  for (const SlowFoot& one : slow) {
    standings.push_back({motion.time(one.begin),
                         motion.time(one.end),
                         one.begin > 0,
                         one.end < motion.num_frames() - 1,
                         {},
                         false,
                         false,
                         one.slowing / motion.rate,
                         one.speeding / motion.rate});
  }
  return standings;
}

/// What differences of the same events of plates and speeds tell.
ContactLag LagOf(std::vector<double> later, ContactLag lag) {
  if (later.empty()) return lag;
  lag.seconds = Median(later);
  lag.share = 0;
  if (later.size() < kEnoughEvents) return lag;
  double squares = 0;
  for (const double one : later) squares += (one - lag.seconds) * (one - lag.seconds);
  lag.deviation = std::sqrt(squares / static_cast<double>(later.size() - 1));
  lag.is_measured = true;
  return lag;
}

struct Lags {
  ContactLag begin, end;
};

using Standings = std::array<std::vector<Standing>, 2>;

Lags FindLags(const Standings& on_plates, const Standings& by_speed) {
  std::vector<double> begins;
  std::vector<double> ends;
  for (std::size_t i = 0; i < on_plates.size(); ++i) {
    for (const Standing& plate : on_plates[i]) {
      for (const Standing& slow : by_speed[i]) {
        if (slow.end < plate.begin || slow.begin > plate.end) continue;
        const double begin = plate.begin - slow.begin;
        const double end = plate.end - slow.end;
        const bool tells_begin = plate.has_begin && !plate.begins_late && slow.has_begin;
        const bool tells_end = plate.has_end && !plate.ends_early && slow.has_end;
        if (tells_begin && std::abs(begin) < kSameEvent) begins.push_back(begin);
        if (tells_end && std::abs(end) < kSameEvent) ends.push_back(end);
      }
    }
  }
  return {LagOf(std::move(begins), kBeginLag), LagOf(std::move(ends), kEndLag)};
}

/// Plates that bear more than this foot while it stands on them.
std::vector<int> SharedPlates(const Standing& standing, const FootPath& foot,
                              const FootMotion& motion, const std::vector<PlateLoad>& loads,
                              const RecordedForces& forces) {
  std::vector<int> plates;
  const double middle = (standing.begin + standing.end) / 2;
  const int k = motion.frame(middle);
  const Eigen::Vector3d heel = foot.heel.col(k);
  const Eigen::Vector3d toe = foot.toe.col(k);
  for (const PlateLoad& load : loads) {
    const ForcePlate& plate = forces.plates[load.plate].plate;
    if (load.bearer != Bearer::kBoth || load.begin > middle || load.end < middle) continue;
    if (IsOver(plate, heel) || IsOver(plate, (heel + toe) / 2) || IsOver(plate, toe)) {
      plates.push_back(plate.number);
    }
  }
  return plates;
}

FootContact ContactOf(Side side, const Standing& standing, const Lags& lags) {
  FootContact contact;
  contact.side = side;
  if (standing.has_begin) contact.begin = standing.begin;
  if (standing.has_end) contact.end = standing.end;
  contact.begin_deviation = lags.begin.DeviationOf(standing.slowing);
  contact.end_deviation = lags.end.DeviationOf(standing.speeding);
  contact.plates = standing.plates;
  return contact;
}

/// The plates' standings, and those of speed between them; an end that speed sees beyond the load,
/// when the foot is half on the floor, is that of speed, and what it sees well beyond any load.
std::vector<FootContact> Combine(Side side, const std::vector<Standing>& on_plates,
                                 std::vector<Standing> by_speed, const Lags& lags) {
  std::vector<FootContact> contacts;
  for (const Standing& plate : on_plates) {
    FootContact contact = ContactOf(side, plate, {{0, kPlateDeviation}, {0, kPlateDeviation}});
    for (Standing& slow : by_speed) {
      if (slow.end <= plate.begin || slow.begin >= plate.end) continue;
      if (plate.begin - slow.begin > (plate.begins_late ? 0 : kSameEvent)) {
        contact.begin = slow.has_begin ? std::optional(slow.begin) : std::nullopt;
        contact.begin_deviation = lags.begin.DeviationOf(slow.slowing);
      }
      if (slow.end - plate.end > (plate.ends_early ? 0 : kSameEvent)) {
        contact.end = slow.has_end ? std::optional(slow.end) : std::nullopt;
        contact.end_deviation = lags.end.DeviationOf(slow.speeding);
      }
      slow.end = slow.begin;  // is told
    }
    contacts.push_back(std::move(contact));
  }
  for (const Standing& slow : by_speed) {
    if (slow.end > slow.begin) contacts.push_back(ContactOf(side, slow, lags));
  }
  std::sort(contacts.begin(), contacts.end(), [](const FootContact& a, const FootContact& b) {
    return a.begin.value_or(-HUGE_VAL) < b.begin.value_or(-HUGE_VAL);
  });
  return contacts;
}

}  // namespace

Contacts FindContacts(const FootMotion& motion, const RecordedForces& forces) {
  if (forces.plates.empty()) return {FindSlowContacts(motion), {}};
  const SlowFeet slow = FindSlowFeet(motion);
  Contacts found;
  found.loads = FindBearers(motion, slow, forces);
  Standings on_plates;
  Standings by_speed;
  for (const Side side : kSides) {
    const auto i = static_cast<std::size_t>(side);
    on_plates[i] = OnPlates(side, found.loads, forces);
    by_speed[i] = BySpeed(motion, slow[i]);
  }
  const Lags lags = FindLags(on_plates, by_speed);
  for (const Side side : kSides) {
    const auto i = static_cast<std::size_t>(side);
    for (Standing& one : by_speed[i]) {
      if (one.has_begin) one.begin += lags.begin.SecondsOf(one.slowing);
      if (one.has_end) one.end += lags.end.SecondsOf(one.speeding);
      one.plates = SharedPlates(one, motion.feet[i], motion, found.loads, forces);
    }
    for (FootContact& one : Combine(side, on_plates[i], by_speed[i], lags)) {
      found.contacts.push_back(std::move(one));
    }
  }
  return found;
}

}  // namespace mmm_converter
