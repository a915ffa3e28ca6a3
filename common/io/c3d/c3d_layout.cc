// SPDX-License-Identifier: MIT
#include "common/io/c3d/c3d_layout.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "common/io/c3d/c3d_numbers.h"
#include "common/motion/marker_sequence.h"

namespace mmm_converter {
namespace {

constexpr double kMaxFrames = 4.0 * (1ULL << 30);  // two words

/// A parameter that counts something: finite and positive.
std::optional<std::uint64_t> Count(const C3dParameters& parameters, const char* name) {
  const std::optional<double> number = parameters.Number("POINT", name);
  if (!number || !(*number >= 1 && *number <= kMaxFrames)) return std::nullopt;
  return static_cast<std::uint64_t>(*number);
}

/// TRIAL:ACTUAL_START_FIELD and ACTUAL_END_FIELD: two words each, the low one first.
std::optional<std::uint64_t> TrialField(const C3dParameters& parameters, const char* name) {
  const C3dParameter* field = parameters.Find("TRIAL", name);
  if (field == nullptr || field->type != 2 || field->size() < 2) return std::nullopt;
  return static_cast<std::uint64_t>(*field->Number(0)) +
         65536 * static_cast<std::uint64_t>(*field->Number(1));
}

bool IsScale(double scale) { return std::isfinite(scale) && scale != 0; }

double SignedScale(const C3dHeader& header, const C3dParameters& parameters, Warnings* warnings) {
  if (IsScale(header.scale)) return header.scale;
  const double scale = parameters.Number("POINT", "SCALE").value_or(0);
  if (IsScale(scale)) return scale;
  Warn(warnings, "no scale in header or POINT:SCALE; coordinates are read as floats");
  return -1;
}

std::uint64_t DataStart(const C3dHeader& header, const C3dParameters& parameters,
                        std::uint64_t section_start, int section_blocks, std::uint64_t file_size,
                        Warnings* warnings) {
  const std::uint64_t by_header =
      C3dDataStartOfHeader(header, section_start, section_blocks, file_size);
  if (by_header != 0) return by_header;
  const std::uint64_t parameters_end = section_start + parameters.end();
  std::uint64_t start = (parameters_end + kBlock - 1) / kBlock * kBlock;
  const std::uint64_t block = Count(parameters, "DATA_START").value_or(0);
  if (block >= 2 && (block - 1) * kBlock >= parameters_end && (block - 1) * kBlock < file_size) {
    start = (block - 1) * kBlock;
  }
  Warn(warnings, fmt::format("the header says that data start in block {}; read from block {}",
                             header.data_block, start / kBlock + 1));
  return start;
}

/// Frames, analog samples of a frame and points, as one place of the file or another says it.
struct Sizes {
  std::uint64_t points = 0;
  std::uint64_t analog_words = 0;
  std::uint64_t frames = 0;

  std::uint64_t FrameBytes(bool floats) const {
    return (4 * points + analog_words) * (floats ? 4 : 2);
  }
};

using Counts = std::vector<std::uint64_t>;

void AddNew(std::uint64_t count, Counts* counts) {
  if (std::find(counts->begin(), counts->end(), count) == counts->end()) counts->push_back(count);
}

std::uint64_t FramesOfTrial(const C3dParameters& parameters) {
  const auto start = TrialField(parameters, "ACTUAL_START_FIELD");
  const auto end = TrialField(parameters, "ACTUAL_END_FIELD");
  return start && end && *end >= *start ? *end - *start + 1 : 0;
}

std::uint64_t FramesOfHeader(const C3dHeader& header) {
  return header.last_frame >= header.first_frame ? header.last_frame - header.first_frame + 1 : 0;
}

/// Whether so many frames are told by a word that says `word`: it is full, or what is left of them.
bool IsMoreThanAWord(std::uint64_t frames, std::uint64_t word) {
  return frames > kFullWord && (word == kFullWord || frames % (kFullWord + 1) == word);
}

/// most: that the file has room for.
std::uint64_t DeclaredFrames(const C3dHeader& header, const C3dParameters& parameters,
                             std::uint64_t most) {
  const std::uint64_t by_header = FramesOfHeader(header);
  const std::uint64_t frames = Count(parameters, "FRAMES").value_or(by_header);
  const std::uint64_t long_frames = Count(parameters, "LONG_FRAMES").value_or(0);
  const std::uint64_t by_trial = FramesOfTrial(parameters);
  if (frames == kFullWord && long_frames > kFullWord) return long_frames;
  if (frames == kFullWord && by_trial > kFullWord) return by_trial;
  for (const std::uint64_t more : {long_frames, by_trial}) {
    if (IsMoreThanAWord(more, frames) && more <= most) return more;
  }
  return frames;
}

/// In the order in which they are believed.
Counts FrameCounts(const C3dHeader& header, const C3dParameters& parameters, std::uint64_t most) {
  Counts counts = {DeclaredFrames(header, parameters, most)};
  AddNew(FramesOfHeader(header), &counts);
  AddNew(FramesOfTrial(parameters), &counts);
  // A word that has overflown says what is left.
  const std::uint64_t left = counts[0] % (kFullWord + 1);
  if (most > kFullWord && most >= left) AddNew(most - (most - left) % (kFullWord + 1), &counts);
  return counts;
}

Counts AnalogWords(const C3dHeader& header, const C3dParameters& parameters, double point_rate,
                   const Sizes& sizes, std::uint64_t room, bool floats) {
  Counts counts = {static_cast<std::uint64_t>(header.analog_words)};
  const double used = parameters.Number("ANALOG", "USED").value_or(0);
  if (!(used >= 1 && used <= kFullWord)) return counts;
  const auto channels = static_cast<std::uint64_t>(used);
  AddNew(channels * static_cast<std::uint64_t>(header.analog_samples), &counts);
  const double samples = parameters.Number("ANALOG", "RATE").value_or(0) / point_rate;
  if (samples >= 1 && samples <= kFullWord) {
    AddNew(channels * static_cast<std::uint64_t>(std::llround(samples)), &counts);
  }
  // As many samples as the data have room for, where one more or less would be seen.
  const std::uint64_t of_a_sample = sizes.frames * channels * (floats ? 4 : 2);
  const std::uint64_t of_points = sizes.frames * 4 * sizes.points * (floats ? 4 : 2);
  if (of_a_sample > 4 * kBlock && room >= of_points) {
    AddNew(channels * ((room - of_points) / of_a_sample), &counts);
  }
  return counts;
}

/// What fills the data to the last block; nothing where no statements together do.
std::optional<Sizes> FindSizesThatFit(const C3dHeader& header, const C3dParameters& parameters,
                                      double rate, std::uint64_t room, bool floats) {
  Counts points = {static_cast<std::uint64_t>(header.points)};
  const std::uint64_t used = Count(parameters, "USED").value_or(0);
  if (used > 0 && used <= kFullWord) AddNew(used, &points);
  for (const std::uint64_t some_points : points) {
    const std::uint64_t declared = DeclaredFrames(header, parameters, 0);
    for (const std::uint64_t words :
         AnalogWords(header, parameters, rate, {some_points, 0, declared}, room, floats)) {
      Sizes sizes{some_points, words, 0};
      const std::uint64_t bytes = sizes.FrameBytes(floats);
      if (some_points == 0 || bytes == 0) continue;
      for (const std::uint64_t frames : FrameCounts(header, parameters, room / bytes)) {
        sizes.frames = frames;
        if (frames > 0 && frames <= room / bytes && room - frames * bytes < kBlock) return sizes;
      }
    }
  }
  return std::nullopt;
}

/// The likelier of the header's and POINT:USED's points, and the frames that are declared.
Sizes LikelySizes(const C3dHeader& header, const C3dParameters& parameters, std::uint64_t room,
                  bool floats) {
  Sizes sizes{static_cast<std::uint64_t>(header.points),
              static_cast<std::uint64_t>(header.analog_words), 0};
  const std::uint64_t used = Count(parameters, "USED").value_or(0);
  const std::uint64_t declared = DeclaredFrames(header, parameters, 0);
  const auto fits = [&](std::uint64_t points, std::uint64_t count) {
    return points > 0 && Sizes{points, sizes.analog_words, 0}.FrameBytes(floats) *
                                 std::max<std::uint64_t>(count, 1) <=
                             room;
  };
  if (used > 0 && used <= kFullWord) {
    const bool by_header =
        fits(sizes.points, declared) || (!fits(used, declared) && fits(sizes.points, 1));
    if (!by_header) sizes.points = used;
  }
  const std::uint64_t bytes = sizes.FrameBytes(floats);
  const std::uint64_t most = bytes > 0 ? room / bytes : 0;
  sizes.frames = DeclaredFrames(header, parameters, most);
  // "More than a word can say", and nobody says how many.
  if (sizes.frames == kFullWord && FramesOfTrial(parameters) != kFullWord) {
    sizes.frames = std::max(sizes.frames, most);
  }
  return sizes;
}

Sizes ResolveSizes(const C3dHeader& header, const C3dParameters& parameters, double rate,
                   std::uint64_t room, bool floats, Warnings* warnings) {
  const std::optional<Sizes> fitting = FindSizesThatFit(header, parameters, rate, room, floats);
  const Sizes sizes = fitting ? *fitting : LikelySizes(header, parameters, room, floats);
  const std::uint64_t used = Count(parameters, "USED").value_or(0);
  if (used > 0 && used <= kFullWord && used != static_cast<std::uint64_t>(header.points)) {
    Warn(warnings, fmt::format("the header says {} points, POINT:USED {}; read as {}",
                               header.points, used, sizes.points));
  }
  if (sizes.analog_words != static_cast<std::uint64_t>(header.analog_words)) {
    Warn(warnings, fmt::format("the header says {} analog samples in a frame; the data's length "
                               "and ANALOG say {}, which are read",
                               header.analog_words, sizes.analog_words));
  }
  const std::uint64_t declared = DeclaredFrames(header, parameters, sizes.frames);
  if (sizes.frames != declared) {
    Warn(warnings, fmt::format("says {} frames; the data's length says {}, which are read",
                               declared, sizes.frames));
  }
  return sizes;
}

double Rate(const C3dHeader& header, const C3dParameters& parameters) {
  const double by_parameter = parameters.Number("POINT", "RATE").value_or(0);
  if (IsFrameRate(by_parameter) || !(header.rate > 0)) return by_parameter;
  return IsFrameRate(header.rate) || !(by_parameter > 0) ? header.rate : by_parameter;
}

}  // namespace

C3dHeader ReadC3dHeader(std::span<const unsigned char> header, C3dProcessor processor) {
  const auto word = [&](int number) { return C3dWord(&header[2 * (number - 1)], processor); };
  const auto real = [&](int number) { return C3dFloat(&header[2 * (number - 1)], processor); };
  return {.points = word(2),
          .analog_words = word(3),
          .first_frame = word(4),
          .last_frame = word(5),
          .scale = real(7),
          .data_block = word(9),
          .analog_samples = word(10),
          .rate = real(11)};
}

std::uint64_t C3dDataStartOfHeader(const C3dHeader& header, std::uint64_t section_start,
                                   int section_blocks, std::uint64_t file_size) {
  if (header.data_block < 2) return 0;
  const std::uint64_t start = (header.data_block - 1) * kBlock;
  const std::uint64_t section_end = section_start + std::max(section_blocks, 1) * kBlock;
  const bool in_section = start >= section_start && start < section_end;
  return in_section || start >= file_size ? 0 : start;
}

C3dLayout ResolveC3dLayout(const C3dHeader& header, const C3dParameters& parameters,
                           C3dProcessor processor, std::uint64_t section_start, int section_blocks,
                           std::uint64_t file_size, Warnings* warnings) {
  C3dLayout layout;
  layout.processor = processor;
  const double scale = SignedScale(header, parameters, warnings);
  layout.floats = scale < 0;
  layout.scale = std::abs(scale);
  layout.rate = Rate(header, parameters);
  layout.first_frame = header.first_frame;
  const auto trial_start = TrialField(parameters, "ACTUAL_START_FIELD");
  if (trial_start && *trial_start % 65536 == static_cast<std::uint64_t>(header.first_frame)) {
    layout.first_frame = static_cast<long>(*trial_start);
  }

  layout.data_start =
      DataStart(header, parameters, section_start, section_blocks, file_size, warnings);
  const std::uint64_t room = file_size - std::min(layout.data_start, file_size);
  const Sizes sizes = ResolveSizes(header, parameters, layout.rate, room, layout.floats, warnings);
  const std::uint64_t declared = sizes.frames;
  layout.declared_frames = static_cast<long>(declared);
  layout.points = static_cast<int>(sizes.points);
  layout.analog_words = static_cast<int>(sizes.analog_words);
  layout.frame_bytes = sizes.FrameBytes(layout.floats);
  if (layout.frame_bytes == 0) return layout;
  const std::uint64_t held = room / layout.frame_bytes;
  if (declared > held) {
    Warn(warnings, fmt::format("truncated: declares {} frames, holds {}", declared, held));
  }
  layout.frames =
      static_cast<int>(std::min<std::uint64_t>({declared, held, std::numeric_limits<int>::max()}));
  return layout;
}

}  // namespace mmm_converter
