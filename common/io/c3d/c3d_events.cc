// SPDX-License-Identifier: MIT
#include "common/io/c3d/c3d_events.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "common/motion/marker_sequence.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

constexpr double kMinute = 60;  // [s]
constexpr std::size_t kMostHeaderEvents = 18;
constexpr int kLongLabels = 12345;  // labels of 4 letters rather than of 2

std::string TextAt(const std::vector<std::string>& texts, std::size_t index) {
  return index < texts.size() ? texts[index] : "";
}

/// EVENT:TIMES is minutes and seconds of each event.
void ReadGroup(const C3dParameters& parameters, std::vector<C3dEvent>* events, Warnings* warnings) {
  const C3dParameter* times = parameters.Find("EVENT", "TIMES");
  const std::size_t stored = times == nullptr ? 0 : times->size() / 2;
  std::size_t used = stored;
  if (const auto number = parameters.Number("EVENT", "USED"); number && *number >= 0) {
    used = static_cast<std::size_t>(std::min(*number, 1e9));
  }
  if (used > stored) {
    Warn(warnings, fmt::format("EVENT:USED says {} events, {} have a time", used, stored));
  }
  const std::vector<std::string> labels = parameters.TextList("EVENT", "LABELS", stored);
  const std::vector<std::string> contexts = parameters.TextList("EVENT", "CONTEXTS", stored);
  const std::vector<std::string> subjects = parameters.TextList("EVENT", "SUBJECTS", stored);
  std::size_t without_time = 0;
  for (std::size_t i = 0; i < std::min(used, stored); ++i) {
    const double time = *times->Number(2 * i) * kMinute + *times->Number(2 * i + 1);
    if (!std::isfinite(time)) {
      ++without_time;
      continue;
    }
    events->push_back({time, TextAt(labels, i), TextAt(contexts, i), TextAt(subjects, i), false});
  }
  if (without_time > 0) {
    Warn(warnings, fmt::format("{} events have a time that is no number", without_time));
  }
}

/// Words 150 to 234 of the header: the length of labels, the count, times, switches, labels.
void ReadHeader(const C3dFile& file, std::vector<C3dEvent>* events, Warnings* warnings) {
  const auto header = file.header_bytes();
  const auto at = [](std::size_t word) { return 2 * (word - 1); };
  const C3dProcessor processor = file.layout().processor;
  const std::size_t count = C3dWord(&header[at(151)], processor);
  if (count == 0) return;
  if (count > kMostHeaderEvents) {
    Warn(warnings,
         fmt::format("the header says {} events, it has room for {}", count, kMostHeaderEvents));
    return;
  }
  const std::size_t letters = C3dWord(&header[at(150)], processor) == kLongLabels ? 4 : 2;
  for (std::size_t i = 0; i < count; ++i) {
    const double time = C3dFloat(&header[at(153) + 4 * i], processor);
    if (!std::isfinite(time)) continue;
    const char* const label = reinterpret_cast<const char*>(&header[at(199) + letters * i]);
    events->push_back({time, std::string(Trim({label, letters})), "", "", true});
  }
}

/// Some systems count from the first stored frame instead of the capture's: where that alone gives
/// times at which there are frames.
void CountFromCapture(const C3dLayout& layout, bool in_header, std::vector<C3dEvent>* events,
                      Warnings* warnings) {
  const double rate = IsFrameRate(layout.rate) ? layout.rate : 0;
  if (rate == 0 || layout.frames == 0) return;
  const double first = layout.first_time(rate);
  const auto are_there = [&](double shift) {
    return std::count_if(events->begin(), events->end(), [&](const C3dEvent& event) {
      const double frame = (event.time + shift - first) * rate;
      return event.is_in_header == in_header && frame >= -0.5 && frame <= layout.frames - 0.5;
    });
  };
  const auto all = std::count_if(events->begin(), events->end(), [&](const C3dEvent& event) {
    return event.is_in_header == in_header;
  });
  if (first == 0 || all == 0 || are_there(0) > 0 || are_there(first) < all) return;
  for (C3dEvent& event : *events) event.time += event.is_in_header == in_header ? first : 0;
  Warn(warnings, fmt::format("times of events{} count from the first stored frame; {:.6g} s added, "
                             "so that they count from the capture's",
                             in_header ? " in the header" : "", first));
}

}  // namespace

std::vector<C3dEvent> ReadC3dEvents(const C3dFile& file, Warnings* warnings) {
  std::vector<C3dEvent> events;
  ReadGroup(file.parameters(), &events, warnings);
  ReadHeader(file, &events, warnings);
  for (const bool in_header : {false, true}) {
    CountFromCapture(file.layout(), in_header, &events, warnings);
  }
  return events;
}

}  // namespace mmm_converter
