// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "common/contacts/contacts.h"

namespace mmm_converter {

/// The mass of a person whom plates bore.
struct MassByPlates {
  double mass = 0;       ///< [kg]
  double deviation = 0;  ///< standard deviation [kg]
  int intervals = 0;     ///< from the middle of a step to that of the next, or of standing
};

/// The mean vertical force is the weight, and what makes the body faster upwards: from mid-stance
/// to mid-stance of steps one after the other, and while a person stands upright and still. Only
/// times count in which all feet on the ground are whole on plates. Nothing: there are none.
std::optional<MassByPlates> EstimateMass(const Contacts& contacts, const RecordedForces& forces,
                                         const FootMotion& motion);

}  // namespace mmm_converter
