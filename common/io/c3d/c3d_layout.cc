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

std::uint64_t DeclaredFrames(const C3dHeader& header, const C3dParameters& parameters) {
  const std::uint64_t by_header =
      header.last_frame >= header.first_frame ? header.last_frame - header.first_frame + 1 : 0;
  const std::uint64_t frames = Count(parameters, "FRAMES").value_or(by_header);
  if (frames != kFullWord) return frames;
  const std::uint64_t long_frames = Count(parameters, "LONG_FRAMES").value_or(0);
  if (long_frames > kFullWord) return long_frames;
  const auto start = TrialField(parameters, "ACTUAL_START_FIELD");
  const auto end = TrialField(parameters, "ACTUAL_END_FIELD");
  if (start && end && *end > *start && *end - *start + 1 > kFullWord) return *end - *start + 1;
  return frames;
}

/// Bytes of a frame with that many points.
std::uint64_t FrameBytes(std::uint64_t points, const C3dHeader& header, bool floats) {
  return (4 * points + header.analog_words) * (floats ? 4 : 2);
}

int NumPoints(const C3dHeader& header, const C3dParameters& parameters, bool floats,
              std::uint64_t frames, std::uint64_t room, Warnings* warnings) {
  const std::uint64_t used = Count(parameters, "USED").value_or(0);
  const std::uint64_t said = header.points;
  if (used == 0 || used == said || used > kFullWord) return header.points;
  const auto fits = [&](std::uint64_t points, std::uint64_t count) {
    return points > 0 &&
           FrameBytes(points, header, floats) * std::max<std::uint64_t>(count, 1) <= room;
  };
  const bool by_header = fits(said, frames) || (!fits(used, frames) && fits(said, 1));
  const int points = static_cast<int>(by_header ? said : used);
  Warn(warnings,
       fmt::format("the header says {} points, POINT:USED {}; read as {}", said, used, points));
  return points;
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
  const std::uint64_t declared = DeclaredFrames(header, parameters);
  layout.declared_frames = static_cast<long>(declared);
  layout.points = NumPoints(header, parameters, layout.floats, declared, room, warnings);
  layout.frame_bytes = FrameBytes(layout.points, header, layout.floats);
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
