// SPDX-License-Identifier: MIT
#include "common/io/c3d/c3d_file.h"

#include <fmt/core.h>

#include <algorithm>
#include <set>

#include "common/io/bytes/file_content.h"
#include "common/io/c3d/c3d_numbers.h"
#include "common/support/error.h"
#include "common/support/opened_files.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

constexpr std::uint64_t kMaxLeadingZeros = 64 * kBlock;
constexpr std::uint64_t kMaxSectionBytes = 65536 * kBlock;

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

/// there: how many the file has.
std::vector<std::string> ListedNames(const C3dParameters& parameters, std::size_t points,
                                     std::size_t* there) {
  std::vector<std::string> names = parameters.TextList("POINT", "LABELS", points, there);
  if (!ToLower(parameters.Text("MANUFACTURER", "COMPANY")).starts_with("motion analysis")) {
    return names;
  }
  const std::vector<std::string> descriptions =
      parameters.TextList("POINT", "DESCRIPTIONS", points);
  names.resize(std::max(names.size(), descriptions.size()));
  *there = std::max(*there, names.size());
  for (std::size_t i = 0; i < descriptions.size(); ++i) {
    if (!descriptions[i].empty()) names[i] = descriptions[i];
  }
  return names;
}

}  // namespace

C3dFile::C3dFile(const std::string& path, Warnings* warnings) : path_(path) {
  const WarningContext context(warnings, path);
  const std::uint64_t file_size = RegularFileSize(path);
  stream_.open(path, std::ios::binary);
  if (!stream_) throw Error(fmt::format("{}: can't be opened", path));
  OpenedFiles::Note(path);

  const auto start = ReadBytes(0, std::min(file_size, kMaxLeadingZeros));
  const auto first = std::find_if(start.begin(), start.end(), [](auto byte) { return byte != 0; });
  if (first != start.end()) base_ = static_cast<std::uint64_t>(first - start.begin());
  const std::uint64_t size = file_size - base_;
  const auto header = ReadBytes(0, std::min(size, kBlock));
  if (header.size() < 2 || header[0] == 0 || header[1] != 0x50) {
    throw Error(fmt::format("{}: not a C3D file: byte 2 must be 0x50", path));
  }
  header_bytes_[0] = header[0];
  const std::uint64_t section_start = this->section_start();
  if (size < kBlock || section_start + 4 > size) {
    throw Error(fmt::format("{}: truncated: {} bytes end before the parameters, at byte {}", path,
                            file_size, base_ + std::max(section_start, kBlock)));
  }
  std::copy(header.begin(), header.end(), header_bytes_.begin());
  const auto section_header = ReadBytes(section_start, 4);
  const C3dProcessor processor = ProcessorOf(section_header[3], path, warnings);
  header_ = ReadC3dHeader(header_bytes_, processor);
  const std::uint64_t data_start =
      C3dDataStartOfHeader(header_, section_start, section_header[2], size);
  const std::uint64_t section_end =
      data_start > section_start ? data_start : std::min(size, section_start + kMaxSectionBytes);
  section_ = ReadBytes(section_start, section_end - section_start);
  parameters_ = C3dParameters(section_, processor, warnings);
  layout_ = ResolveC3dLayout(header_, parameters_, processor, section_start, section_header[2],
                             size, warnings);
  data_bytes_ = size - std::min(size, layout_.data_start);
}

std::vector<unsigned char> C3dFile::ReadBytes(std::uint64_t begin, std::uint64_t count) {
  std::vector<unsigned char> bytes(count);
  stream_.clear();
  stream_.seekg(static_cast<std::streamoff>(base_ + begin));
  stream_.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(count));
  if (!stream_) throw Error(fmt::format("{}: can't be read at byte {}", path_, base_ + begin));
  return bytes;
}

void C3dFile::ReadFrames(int first, int count, std::vector<unsigned char>* bytes) {
  bytes->resize(layout_.frame_bytes * count);
  stream_.clear();
  stream_.seekg(
      static_cast<std::streamoff>(base_ + layout_.data_start + layout_.frame_bytes * first));
  stream_.read(reinterpret_cast<char*>(bytes->data()), static_cast<std::streamsize>(bytes->size()));
  if (!stream_) {
    throw Error(
        fmt::format("{}: can't be read at frame {}; has it changed meanwhile?", path_, first));
  }
}

void C3dFile::ReadAllFrames(const TakeFrames& take) {
  if (layout_.frames == 0 || layout_.frame_bytes == 0) return;
  const int most = static_cast<int>(std::clamp<std::uint64_t>(
      kBufferBytes / layout_.frame_bytes, 1, static_cast<std::uint64_t>(layout_.frames)));
  std::vector<unsigned char> bytes;
  for (int k = 0; k < layout_.frames; k += most) {
    const int count = std::min(most, layout_.frames - k);
    ReadFrames(k, count, &bytes);
    take(k, count, bytes.data());
  }
}

std::vector<std::string> C3dPointNames(const C3dFile& file, Warnings* warnings) {
  const std::size_t points = file.layout().points;
  std::size_t there = 0;
  std::vector<std::string> names = ListedNames(file.parameters(), points, &there);
  if (there != points) Warn(warnings, fmt::format("{} labels for {} points", there, points));
  names.resize(points);
  std::set<std::string> seen;
  std::string repeated;
  for (std::size_t i = 0; i < points; ++i) {
    if (names[i].empty()) names[i] = fmt::format("*{}", i + 1);
    if (seen.insert(names[i]).second) continue;
    if (repeated.size() < 200) repeated += (repeated.empty() ? " " : ", ") + names[i];
    names[i] = fmt::format("*{}#{}", names[i], i + 1);
    seen.insert(names[i]);
  }
  if (!repeated.empty()) {
    Warn(warnings, "labels that are there twice; the first is used:" + repeated);
  }
  return names;
}

std::vector<std::string> C3dOutputNames(const C3dFile& file) {
  const C3dParameters& parameters = file.parameters();
  const std::size_t points = file.layout().points;
  std::vector<std::string> outputs;
  for (const char* kind :
       {"ANGLES", "FORCES", "MOMENTS", "POWERS", "SCALARS", "REACTIONS", "MODELED_MARKERS"}) {
    for (std::string& name : parameters.TextList("POINT", kind, points))
      outputs.push_back(std::move(name));
  }
  return outputs;
}

}  // namespace mmm_converter
