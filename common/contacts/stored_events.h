// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/contacts/contact_table.h"
#include "common/io/c3d/c3d_events.h"

namespace mmm_converter {

/// Whose events count: of each foot the file's where it has all that are found; the file's; those
/// that are found.
enum class EventChoice { kWhereComplete, kFile, kFound };

/// When a file says that feet come to the ground and leave it.
struct StoredEvents {
  EventChoice choice = EventChoice::kWhereComplete;
  std::vector<ContactEvent> events;  ///< over time
};

/// "Foot Strike" of the context "Left", "RHS", "Toe Off" and the like; nothing: of no foot.
std::optional<ContactEvent> FootEventOf(const C3dEvent& event);

/// Those of the person's feet, over time; of the header where there are no others. person: empty:
/// of any.
std::vector<ContactEvent> FootEventsOf(const std::vector<C3dEvent>& all, const std::string& person);

/// Whether one of `events` says the same of the same foot within 0.15 s.
bool IsAmong(const std::vector<ContactEvent>& events, const ContactEvent& one);

/// What speaks against the file's events, in a sentence: they fit the found contacts with left and
/// right exchanged. Empty: nothing.
std::string DoubtOfEvents(const StoredEvents& stored, const FootMotion& motion,
                          const Contacts& found);

/// `found`, but of feet whose stored events count the contacts that these tell. notes: whose count,
/// stored events that contradict plates by more than 40 ms, and DoubtOfEvents, of which none count.
Contacts WithStoredEvents(const StoredEvents& stored, const FootMotion& motion,
                          const Contacts& found, const RecordedForces& forces,
                          std::vector<std::string>* notes);

}  // namespace mmm_converter
