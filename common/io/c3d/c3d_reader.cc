// SPDX-License-Identifier: MIT
#include "common/io/c3d/c3d_reader.h"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <set>

#include "common/io/bytes/file_content.h"
#include "common/io/c3d/c3d_data.h"
#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

constexpr std::uint64_t kBlock = 512;
constexpr std::uint64_t kMaxLeadingZeros = 64 * kBlock;
constexpr std::uint64_t kMaxSectionBytes = 65536 * kBlock;
constexpr std::uint64_t kBufferBytes = 1 << 20;

C3dProcessor ProcessorOf(int byte, const std::string& path, Warnings* warnings) {
  if (byte >= 84 && byte <= 86) return static_cast<C3dProcessor>(byte);
  if (byte >= 1 && byte <= 3) {
    Warn(warnings, fmt::format("processor type {} is read as {}", byte, byte + 83));
    return static_cast<C3dProcessor>(byte + 83);
  }
  throw Error(fmt::format(
      "{}: not a C3D file that can be read: processor type {} (84 Intel, 85 DEC, 86 MIPS)", path,
      byte));
}

/// One name for each point: as listed, numbered where the list says nothing or a name twice.
std::vector<std::string> PointNames(std::vector<std::string> names, std::size_t points,
                                    Warnings* warnings) {
  if (names.size() != points) {
    Warn(warnings, fmt::format("{} labels for {} points", names.size(), points));
  }
  names.resize(points);
  std::set<std::string> seen;
  std::string repeated;
  for (std::size_t i = 0; i < points; ++i) {
    if (names[i].empty()) names[i] = fmt::format("*{}", i + 1);
    if (seen.insert(names[i]).second) continue;
    if (repeated.size() < 200) repeated += " " + names[i];
    names[i] = fmt::format("*{}#{}", names[i], i + 1);
    seen.insert(names[i]);
  }
  if (!repeated.empty()) {
    Warn(warnings, "labels that are there twice; the first is used:" + repeated);
  }
  return names;
}

std::vector<std::string> ListedNames(const C3dParameters& parameters) {
  std::vector<std::string> names = parameters.TextList("POINT", "LABELS");
  if (!ToLower(parameters.Text("MANUFACTURER", "COMPANY")).starts_with("motion analysis")) {
    return names;
  }
  const std::vector<std::string> descriptions = parameters.TextList("POINT", "DESCRIPTIONS");
  names.resize(std::max(names.size(), descriptions.size()));
  for (std::size_t i = 0; i < descriptions.size(); ++i) {
    if (!descriptions[i].empty()) names[i] = descriptions[i];
  }
  return names;
}

}  // namespace

C3dReader::C3dReader(const std::string& path, Warnings* warnings) : path_(path) {
  const WarningContext context(warnings, path);
  const std::uint64_t file_size = RegularFileSize(path);
  stream_.open(path, std::ios::binary);
  if (!stream_) throw Error(fmt::format("{}: can't be opened", path));

  const auto start = ReadBytes(0, std::min(file_size, kMaxLeadingZeros));
  const auto first = std::find_if(start.begin(), start.end(), [](auto byte) { return byte != 0; });
  if (first != start.end()) base_ = static_cast<std::uint64_t>(first - start.begin());
  const std::uint64_t size = file_size - base_;
  const auto header_bytes = ReadBytes(0, std::min(size, kBlock));
  if (header_bytes.size() < 2 || header_bytes[0] == 0 || header_bytes[1] != 0x50) {
    throw Error(fmt::format("{}: not a C3D file: byte 2 must be 0x50", path));
  }
  const std::uint64_t section_start = (header_bytes[0] - 1) * kBlock;
  if (size < kBlock || section_start + 4 > size) {
    throw Error(fmt::format("{}: truncated: {} bytes end before the parameters, at byte {}", path,
                            file_size, base_ + std::max(section_start, kBlock)));
  }
  const auto section_header = ReadBytes(section_start, 4);
  const C3dProcessor processor = ProcessorOf(section_header[3], path, warnings);
  const C3dHeader header = ReadC3dHeader(header_bytes, processor);
  const std::uint64_t data_start =
      C3dDataStartOfHeader(header, section_start, section_header[2], size);
  const std::uint64_t section_end =
      data_start > section_start ? data_start : std::min(size, section_start + kMaxSectionBytes);
  const auto section = ReadBytes(section_start, section_end - section_start);
  const C3dParameters parameters(section, processor, warnings);
  info_.layout = ResolveC3dLayout(header, parameters, processor, section_start, section_header[2],
                                  size, warnings);
  if (info_.layout.points == 0) throw Error(fmt::format("{}: the file holds no points", path));
  if (info_.layout.frames == 0) {
    throw Error(
        fmt::format("{}: no whole frame: {} points need {} bytes a frame, {} bytes follow "
                    "the header and parameters",
                    path, info_.layout.points, info_.layout.frame_bytes,
                    size - std::min(size, info_.layout.data_start)));
  }
  info_.unit = parameters.Text("POINT", "UNITS");
  info_.labels = PointNames(ListedNames(parameters), info_.layout.points, warnings);
  for (const char* kind :
       {"ANGLES", "FORCES", "MOMENTS", "POWERS", "SCALARS", "REACTIONS", "MODELED_MARKERS"}) {
    for (std::string& name : parameters.TextList("POINT", kind)) {
      info_.outputs.push_back(std::move(name));
    }
  }
  info_.label_prefixes = parameters.TextList("SUBJECTS", "LABEL_PREFIXES");
  info_.comment = parameters.Text("MANUFACTURER", "COMMENT");
}

std::vector<unsigned char> C3dReader::ReadBytes(std::uint64_t begin, std::uint64_t count) {
  std::vector<unsigned char> bytes(count);
  stream_.seekg(static_cast<std::streamoff>(base_ + begin));
  stream_.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(count));
  if (!stream_) throw Error(fmt::format("{}: can't be read at byte {}", path_, base_ + begin));
  return bytes;
}

MarkerSequence C3dReader::ReadPoints(const std::vector<int>& points,
                                     const std::vector<std::string>& labels, double rate,
                                     bool ignore_residuals) {
  const C3dLayout& layout = info_.layout;
  MarkerSequence sequence(labels, layout.frames, rate, 0);
  if (points.empty()) return sequence;
  const int chunk = static_cast<int>(
      std::clamp<std::uint64_t>(kBufferBytes / layout.frame_bytes, 1, layout.frames));
  std::vector<unsigned char> bytes;
  for (int k = 0; k < layout.frames; k += chunk) {
    const int count = std::min(chunk, layout.frames - k);
    ReadFrames(k, count, &bytes);
    DecodeC3dFrames(bytes.data(), count, points, layout, ignore_residuals,
                    sequence.frame(k).data());
  }
  return sequence;
}

std::vector<C3dPoint> C3dReader::ReadFrame(int frame) {
  const C3dLayout& layout = info_.layout;
  std::vector<unsigned char> bytes;
  ReadFrames(frame, 1, &bytes);
  std::vector<C3dPoint> points(layout.points);
  const int point_bytes = layout.floats ? 16 : 8;
  for (int i = 0; i < layout.points; ++i) {
    const unsigned char* stored = &bytes[static_cast<std::size_t>(i) * point_bytes];
    const C3dPointWord word = DecodeC3dPointWord(stored, layout);
    DecodeC3dPosition(stored, layout, points[i].position.data());
    points[i].valid = word.valid && points[i].position.allFinite();
    if (!points[i].valid) continue;
    points[i].residual =
        word.known ? word.residual * layout.scale : std::numeric_limits<double>::quiet_NaN();
    points[i].cameras = word.cameras;
  }
  return points;
}

void C3dReader::ReadFrames(int first, int count, std::vector<unsigned char>* bytes) {
  const C3dLayout& layout = info_.layout;
  bytes->resize(layout.frame_bytes * count);
  stream_.clear();
  stream_.seekg(
      static_cast<std::streamoff>(base_ + layout.data_start + layout.frame_bytes * first));
  stream_.read(reinterpret_cast<char*>(bytes->data()), static_cast<std::streamsize>(bytes->size()));
  if (!stream_) {
    throw Error(
        fmt::format("{}: can't be read at frame {}; has it changed meanwhile?", path_, first));
  }
}

}  // namespace mmm_converter
