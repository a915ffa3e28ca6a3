// SPDX-License-Identifier: MIT
#include "common/contacts/contact_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/io/xml/xml_text.h"

namespace mmm_converter {
namespace {

constexpr int kDecimals = 6;

std::string Decimal(double value) {
  std::string text;
  AppendDecimal(value, kDecimals, &text);
  return text;
}

std::string Decimal(const std::optional<double>& value, const char* nothing) {
  return value ? Decimal(*value) : nothing;
}

std::string JsonNumber(double value) { return std::isfinite(value) ? Decimal(value) : "null"; }

std::string JsonList(const std::vector<std::string>& items) {
  return items.empty() ? "[]" : fmt::format("[\n    {}\n  ]", fmt::join(items, ",\n    "));
}

}  // namespace

std::vector<ContactEvent> EventsOf(const Contacts& contacts) {
  std::vector<ContactEvent> events;
  for (const FootContact& one : contacts.contacts) {
    if (one.begin) events.push_back({*one.begin, "Foot Strike", one.side});
    if (one.end) events.push_back({*one.end, "Foot Off", one.side});
  }
  std::stable_sort(events.begin(), events.end(),
                   [](const ContactEvent& a, const ContactEvent& b) { return a.time < b.time; });
  return events;
}

const char* ContextOf(Side side) { return side == Side::kLeft ? "Left" : "Right"; }

std::string FormatContactsCsv(const Contacts& contacts) {
  std::string text = "foot,begin_s,begin_deviation_s,end_s,end_deviation_s,plates\n";
  for (const FootContact& one : contacts.contacts) {
    text += fmt::format("{},{},{},{},{},{}\n", Name(one.side), Decimal(one.begin, ""),
                        one.begin ? Decimal(one.begin_deviation) : "", Decimal(one.end, ""),
                        one.end ? Decimal(one.end_deviation) : "", fmt::join(one.plates, ";"));
  }
  return text;
}

std::string FormatContactsJson(const Contacts& contacts, const RecordedForces& forces,
                               const std::optional<MassByPlates>& mass) {
  std::vector<std::string> list;
  for (const FootContact& one : contacts.contacts) {
    list.push_back(
        fmt::format(R"({{"foot": "{}", "begin_s": {}, "begin_deviation_s": {}, "end_s": {}, )"
                    R"("end_deviation_s": {}, "plates": [{}]}})",
                    Name(one.side), Decimal(one.begin, "null"),
                    one.begin ? Decimal(one.begin_deviation) : "null", Decimal(one.end, "null"),
                    one.end ? Decimal(one.end_deviation) : "null", fmt::join(one.plates, ", ")));
  }
  std::vector<std::string> events;
  for (const ContactEvent& one : EventsOf(contacts)) {
    events.push_back(fmt::format(R"({{"time_s": {}, "label": "{}", "context": "{}"}})",
                                 Decimal(one.time), one.label, ContextOf(one.side)));
  }
  std::vector<std::string> loads;
  for (const PlateLoad& one : contacts.loads) {
    loads.push_back(
        fmt::format(R"({{"plate": {}, "begin_s": {}, "end_s": {}, "foot": "{}", )"
                    R"("distance_left_m": {}, "distance_right_m": {}, "part_of_foot": {}}})",
                    forces.plates[one.plate].plate.number, Decimal(one.begin), Decimal(one.end),
                    Name(one.bearer), JsonNumber(one.distances[0]), JsonNumber(one.distances[1]),
                    one.is_part_of_foot));
  }
  std::string borne = "null";
  if (mass) {
    borne = fmt::format(R"({{"kg": {}, "deviation_kg": {}, "intervals": {}}})", Decimal(mass->mass),
                        Decimal(mass->deviation), mass->intervals);
  }
  return fmt::format(
      "{{\n  \"contacts\": {},\n  \"events\": {},\n  \"loads\": {},\n  \"mass\": {}\n}}\n",
      JsonList(list), JsonList(events), JsonList(loads), borne);
}

}  // namespace mmm_converter
