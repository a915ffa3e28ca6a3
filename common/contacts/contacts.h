// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "common/contacts/foot_motion.h"
#include "common/forces/plate_forces.h"

namespace mmm_converter {

/// Who stood on a plate while it bore somebody.
enum class Bearer {
  kLeft,
  kRight,
  kBoth,    ///< or one after the other: the centre of pressure does not tell a side
  kUnknown  ///< no foot is near the centre of pressure, or none is known
};
const char* Name(Bearer bearer);  ///< "left", "right", "both", "unknown"

struct PlateLoad {
  std::size_t plate = 0;      ///< of RecordedForces::plates
  LoadInterval samples;       ///< as it has them
  double begin = 0, end = 0;  ///< [s]
  Bearer bearer = Bearer::kUnknown;
  /// Median horizontal distances of the centre of pressure from the heel-toe lines of the left and
  /// the right foot [m]; NaN: no frame tells them.
  std::array<double, 2> distances = {};
  /// The bearer stands with heel or toe beside the plate, which then bears a part of it alone.
  bool is_part_of_foot = false;
  /// So far beside it rest heel and toe then [m]; 0: on it.
  std::array<double, 2> beside = {};
  /// What is beside it bore the foot before the load began, or after it ended.
  bool begins_late = false, ends_early = false;
};

/// A foot on the ground.
struct FootContact {
  Side side = Side::kLeft;
  /// [s]; nothing: it began before, or ended after, what was recorded.
  std::optional<double> begin, end;
  double begin_deviation = 0, end_deviation = 0;  ///< standard deviations [s]
  std::vector<int> plates;                        ///< numbers of those that bear it
};

struct Contacts {
  std::vector<PlateLoad> loads;       ///< in the order of the plates
  std::vector<FootContact> contacts;  ///< the left foot's, then the right foot's, over time

  /// Of frames at first_time + k / rate [s, Hz]: whether a foot stands.
  std::vector<bool> StandingFrames(Side side, double first_time, double rate, int frames) const;
};

/// Which foot stands where and when, for all that asks. On plates: of whose heel-toe line the
/// loaded centre of pressure is nearest, and when the load says. Elsewhere, or where both feet are
/// on a plate: a foot stands while its heel or its toe is low above floor or step and slow
/// (ground_rules.h). What the plates say of the same feet in the same recording corrects when that
/// is.
Contacts FindContacts(const FootMotion& motion, const RecordedForces& forces);

}  // namespace mmm_converter
