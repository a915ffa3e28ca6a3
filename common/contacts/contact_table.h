// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/contacts/contacts.h"
#include "common/contacts/person_mass.h"

namespace mmm_converter {

/// A line for each contact: foot, begin_s, begin_deviation_s, end_s, end_deviation_s, plates (with
/// ; between them). Empty: not within what was recorded.
std::string FormatContactsCsv(const Contacts& contacts);

struct ContactEvent {
  double time = 0;         ///< [s]
  const char* label = "";  ///< as C3D files name it: "Foot Strike", "Foot Off"
  Side side = Side::kLeft;
};

/// When feet come to the ground and leave it, over time.
std::vector<ContactEvent> EventsOf(const Contacts& contacts);
/// "Left", "Right", as C3D files name a side.
const char* ContextOf(Side side);

/// The same as the CSV, with the events as C3D files name them ("Foot Strike", "Foot Off"), who was
/// found on the plates, and the mass that they tell.
std::string FormatContactsJson(const Contacts& contacts, const RecordedForces& forces,
                               const std::optional<MassByPlates>& mass);

}  // namespace mmm_converter
