// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "common/forces/plate_forces.h"
#include "common/motion/foot_motion.h"
#include "common/motion/foot_states.h"

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

struct Contacts : FootContacts {
  std::vector<PlateLoad> loads;  ///< in the order of the plates
};

/// Which foot stands where and when, for all that asks. On plates: of whose heel-toe line the
/// loaded centre of pressure is nearest, and when the load says. Elsewhere, or where both feet are
/// on a plate: a foot stands while its heel or its toe is low above floor or step and slow
/// (ground_rules.h). What the plates say of the same feet in the same recording corrects when that
/// is.
Contacts FindContacts(const FootMotion& motion, const RecordedForces& forces);

}  // namespace mmm_converter
