// SPDX-License-Identifier: MIT
#include "common/contacts/stored_events.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>
#include <utility>

#include "common/support/advice.h"
#include "common/support/text.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

constexpr const char* kStrike = "Foot Strike";
constexpr const char* kOff = "Foot Off";
constexpr double kSameStep = 0.15;         // [s]
constexpr double kContradiction = 0.04;    // [s] more than what thresholds differ by
constexpr double kFarthestEvent = 0.3;     // [s] else it is of another step
constexpr double kStoredDeviation = 0.01;  // [s] people set events by frames
constexpr double kUncut = 0.1;             // [s] of a contact whose other end is not told
constexpr std::size_t kMostNamed = 6;      // contradictions
constexpr std::size_t kFewest = 3;         // events that tell an exchange ...
constexpr std::size_t kTimesMore = 3;      // ... and so many times those that fit as they are

using Events = std::vector<ContactEvent>;

bool IsStrike(const ContactEvent& one) { return std::string_view(one.label) == kStrike; }

bool IsSameKind(const ContactEvent& a, const ContactEvent& b) {
  return a.side == b.side && IsStrike(a) == IsStrike(b);
}

/// The label in C3D's words, by its letters without those of a side; null: of no foot.
const char* LabelOf(std::string_view letters) {
  for (const char* name : {"footstrike", "heelstrike", "footcontact", "initialcontact", "footon",
                           "heelcontact", "fs", "hs", "ic", "fc"}) {
    if (letters == name) return kStrike;
  }
  for (const char* name : {"footoff", "toeoff", "fo", "to"}) {
    if (letters == name) return kOff;
  }
  return nullptr;
}

Events OfSide(const Events& events, Side side) {
  Events own;
  std::copy_if(events.begin(), events.end(), std::back_inserter(own),
               [&](const ContactEvent& one) { return one.side == side; });
  return own;
}

bool Alternate(const Events& events) {
  return std::adjacent_find(events.begin(), events.end(), IsSameKind) == events.end();
}

std::size_t CountAmong(const Events& found, const Events& stored) {
  return static_cast<std::size_t>(std::count_if(
      found.begin(), found.end(), [&](const ContactEvent& one) { return IsAmong(stored, one); }));
}

/// Of the times of the motion.
Events EventsIn(const FootMotion& motion, Events events) {
  const double half = 0.5 / motion.rate;
  std::erase_if(events, [&](const ContactEvent& one) {
    return one.time < motion.first_time - half ||
           one.time > motion.time(motion.num_frames() - 1) + half;
  });
  return events;
}

std::vector<FootContact> ContactsBetween(const Events& events, Side side, const Contacts& found) {
  std::vector<FootContact> contacts;
  for (const ContactEvent& one : events) {
    if (IsStrike(one) || contacts.empty() || contacts.back().end) {
      contacts.emplace_back();
      contacts.back().side = side;
      contacts.back().begin_deviation = contacts.back().end_deviation = kStoredDeviation;
      if (IsStrike(one)) contacts.back().begin = one.time;
    }
    if (!IsStrike(one)) contacts.back().end = one.time;
  }
  for (FootContact& contact : contacts) {
    const double begin = contact.begin ? *contact.begin : *contact.end - kUncut;
    const double end = contact.end ? *contact.end : *contact.begin + kUncut;
    for (const FootContact& one : found.contacts) {
      if (one.side != side || one.begin.value_or(-HUGE_VAL) >= end ||
          one.end.value_or(HUGE_VAL) <= begin) {
        continue;
      }
      contact.plates.insert(contact.plates.end(), one.plates.begin(), one.plates.end());
    }
  }
  return contacts;
}

/// An event that a plate tells.
struct PlateEvent {
  ContactEvent event;
  int plate = 0;
};

std::vector<PlateEvent> PlateEventsOf(const Contacts& found, const RecordedForces& forces) {
  std::vector<PlateEvent> events;
  for (const FootContact& one : found.contacts) {
    for (const PlateLoad& load : found.loads) {
      const Bearer bearer = one.side == Side::kLeft ? Bearer::kLeft : Bearer::kRight;
      if (load.bearer != bearer || load.is_part_of_foot) continue;
      const int number = forces.plates[load.plate].plate.number;
      if (one.begin == load.begin) events.push_back({{load.begin, kStrike, one.side}, number});
      if (one.end == load.end) events.push_back({{load.end, kOff, one.side}, number});
    }
  }
  return events;
}

std::string ContradictionsOf(const Events& stored, const Contacts& found,
                             const RecordedForces& forces) {
  const std::vector<PlateEvent> of_plates = PlateEventsOf(found, forces);
  std::vector<std::string> texts;
  for (const ContactEvent& one : stored) {
    const PlateEvent* nearest = nullptr;
    const auto apart = [&](const PlateEvent& other) { return other.event.time - one.time; };
    for (const PlateEvent& other : of_plates) {
      if (!IsSameKind(one, other.event)) continue;
      if (nearest == nullptr || std::abs(apart(other)) < std::abs(apart(*nearest))) {
        nearest = &other;
      }
    }
    if (nearest == nullptr) continue;
    const double later = apart(*nearest);
    if (std::abs(later) <= kContradiction || std::abs(later) > kFarthestEvent) continue;
    texts.push_back(fmt::format("{} {} at {:.3f} s (plate {}: {:.3f} s)", ContextOf(one.side),
                                one.label, one.time, nearest->plate, nearest->event.time));
  }
  if (texts.empty()) return "";
  const std::size_t more = texts.size() > kMostNamed ? texts.size() - kMostNamed : 0;
  texts.resize(texts.size() - more);
  return fmt::format("events of the file are more than {:.0f} ms from what force plates say: {}{}",
                     kMilliseconds * kContradiction, JoinNames(texts, ", "),
                     more > 0 ? fmt::format(" and {} more", more) : "");
}

}  // namespace

std::optional<ContactEvent> FootEventOf(const C3dEvent& event) {
  std::string letters;
  for (const char c : ToLower(event.label)) {
    if (c >= 'a' && c <= 'z') letters += c;
  }
  const std::pair<const char*, Side> sides[] = {
      {"left", Side::kLeft}, {"right", Side::kRight}, {"l", Side::kLeft}, {"r", Side::kRight}};
  for (const auto& [prefix, side] : sides) {
    if (!letters.starts_with(prefix)) continue;
    const char* label = LabelOf(std::string_view(letters).substr(std::string_view(prefix).size()));
    if (label != nullptr) return ContactEvent{event.time, label, side};
  }
  const char* label = LabelOf(letters);
  const std::string context = ToLower(event.context);
  if (label == nullptr || (context != "left" && context != "right")) return std::nullopt;
  return ContactEvent{event.time, label, context == "left" ? Side::kLeft : Side::kRight};
}

std::vector<ContactEvent> FootEventsOf(const std::vector<C3dEvent>& all,
                                       const std::string& person) {
  Events of_group, of_header;
  for (const C3dEvent& one : all) {
    if (!one.subject.empty() && !person.empty() && one.subject != person) continue;
    const auto event = FootEventOf(one);
    if (event) (one.is_in_header ? of_header : of_group).push_back(*event);
  }
  Events events = of_group.empty() ? of_header : of_group;
  std::stable_sort(events.begin(), events.end(),
                   [](const ContactEvent& a, const ContactEvent& b) { return a.time < b.time; });
  return events;
}

bool IsAmong(const std::vector<ContactEvent>& events, const ContactEvent& one) {
  return std::any_of(events.begin(), events.end(), [&](const ContactEvent& other) {
    return IsSameKind(one, other) && std::abs(one.time - other.time) < kSameStep;
  });
}

std::string DoubtOfEvents(const StoredEvents& stored, const FootMotion& motion,
                          const Contacts& found) {
  const Events events = EventsIn(motion, stored.events), all_found = EventsOf(found);
  Events exchanged = events;
  for (ContactEvent& one : exchanged) {
    one.side = one.side == Side::kLeft ? Side::kRight : Side::kLeft;
  }
  const std::size_t as_told = CountAmong(events, all_found);
  const std::size_t otherwise = CountAmong(exchanged, all_found);
  if (otherwise < kFewest || 2 * otherwise <= events.size() || otherwise < kTimesMore * as_told) {
    return "";
  }
  return fmt::format(
      "the file's events have left and right exchanged: {} of {} are when the other foot comes or "
      "goes, {} when the own one does; they do not count, those that are found do",
      otherwise, events.size(), as_told);
}

Contacts WithStoredEvents(const StoredEvents& stored, const FootMotion& motion,
                          const Contacts& found, const RecordedForces& forces,
                          std::vector<std::string>* notes) {
  const Events events = EventsIn(motion, stored.events);
  if (events.empty()) return found;
  if (std::string doubt = DoubtOfEvents(stored, motion, found); !doubt.empty()) {
    notes->push_back(std::move(doubt));
    return found;
  }
  if (std::string text = ContradictionsOf(events, found, forces); !text.empty()) {
    notes->push_back(std::move(text));
  }
  if (stored.choice == EventChoice::kFound) return found;
  const Events all_found = EventsOf(found);
  Contacts told;
  told.loads = found.loads;
  std::vector<std::string> taken;
  for (const Side side : kSides) {
    const Events own = OfSide(events, side), own_found = OfSide(all_found, side);
    const std::size_t known = CountAmong(own_found, own);
    const bool counts = stored.choice == EventChoice::kFile ||
                        (own.size() > 1 && Alternate(own) && known == own_found.size());
    if (counts) {
      const std::vector<FootContact> contacts = ContactsBetween(own, side, found);
      told.contacts.insert(told.contacts.end(), contacts.begin(), contacts.end());
      if (!own.empty()) taken.emplace_back(Name(side));
      continue;
    }
    std::copy_if(found.contacts.begin(), found.contacts.end(), std::back_inserter(told.contacts),
                 [&](const FootContact& one) { return one.side == side; });
    if (own.empty()) continue;
    notes->push_back(fmt::format(
        "the file has {} of {} events of the {} foot that are found{}: those that are found count "
        "(others by {})",
        known, own_found.size(), Name(side),
        Alternate(own) ? "" : ", and strikes and offs do not take turns", OptionText("events")));
  }
  if (!taken.empty()) {
    notes->push_back(
        fmt::format("contacts and strides of the {} foot are by the file's events "
                    "(others by {})",
                    JoinNames(taken, " and the "), OptionText("events")));
  }
  return told;
}

}  // namespace mmm_converter
