// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "common/contacts/contacts.h"

namespace mmm_converter {

/// A line for each contact: foot, begin_s, begin_deviation_s, end_s, end_deviation_s, plates (with
/// ; between them). Empty: not within what was recorded.
std::string FormatContactsCsv(const Contacts& contacts);

/// The same, with the events as C3D files name them ("Foot Strike", "Foot Off"), who was found on
/// the plates, and the mass that they tell.
std::string FormatContactsJson(const Contacts& contacts, const RecordedForces& forces);

}  // namespace mmm_converter
