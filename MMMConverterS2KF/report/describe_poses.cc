// SPDX-License-Identifier: MIT
// Files of poses for other programs: NumPy's .npz and BVH.
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "MMMConverterS2KF/report/describe.h"
#include "common/io/bytes/file_content.h"
#include "common/support/error.h"
#include "common/support/line_file.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

constexpr std::string_view kBvhStart = "HIERARCHY";
constexpr std::string_view kZipEntry = "PK\x03\x04";
constexpr std::size_t kZipHeader = 30;  // bytes of an entry's header before its name
constexpr std::size_t kNpyHead = 512;   // bytes in which an array says what it is
constexpr std::size_t kMostArrays = 1000;

std::uint64_t LittleEndian(std::string_view bytes, std::size_t at, std::size_t count) {
  std::uint64_t value = 0;
  for (std::size_t i = count; i-- > 0;) {
    value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  }
  return value;
}

std::string Piece(const ByteSource& file, std::uint64_t begin, std::uint64_t count) {
  std::string bytes(std::min(count, file.size - std::min(begin, file.size)), '\0');
  if (!bytes.empty()) file.read(begin, bytes.size(), bytes.data());
  return bytes;
}

// What stands behind a key of a .npy header, with the signs around it: "(675, 21, 3)".
std::string HeaderValue(std::string_view head, std::string_view key, char first, char last) {
  const std::size_t at = head.find(key);
  if (at == std::string_view::npos) return "?";
  const std::size_t begin = head.find(first, at + key.size());
  const std::size_t end = begin == std::string_view::npos ? begin : head.find(last, begin + 1);
  if (end == std::string_view::npos) return "?";
  return ToUtf8(head.substr(begin, end + 1 - begin));
}

struct NpzEntry {
  std::string name, type, shape;
};

// The arrays of an archive that is stored, one entry behind the other.
std::vector<NpzEntry> ReadNpzEntries(const std::string& path) {
  const ByteSource file = BytesOfFile(path);
  std::vector<NpzEntry> entries;
  for (std::uint64_t at = 0; at < file.size && entries.size() < kMostArrays;) {
    const std::string header = Piece(file, at, kZipHeader);
    if (header.size() < kZipHeader || !header.starts_with(kZipEntry)) break;
    const std::uint64_t method = LittleEndian(header, 8, 2);
    std::uint64_t size = LittleEndian(header, 18, 4);
    const std::uint64_t name_size = LittleEndian(header, 26, 2);
    const std::uint64_t data = at + kZipHeader + name_size + LittleEndian(header, 28, 2);
    if (size == 0xffffffff) {  // of ZIP64, as NumPy writes them
      const std::string extra = Piece(file, at + kZipHeader + name_size, 20);
      size = extra.size() == 20 ? LittleEndian(extra, 12, 8) : file.size;
      if (size > file.size) break;
    }
    NpzEntry entry;
    entry.name = ToUtf8(Piece(file, at + kZipHeader, name_size));
    if (entry.name.ends_with(".npy")) entry.name.resize(entry.name.size() - 4);
    const std::string head =
        method == 0 ? Piece(file, data, std::min<std::uint64_t>(size, kNpyHead)) : std::string();
    entry.type = HeaderValue(head, "'descr':", '\'', '\'');
    std::erase(entry.type, '\'');
    entry.shape = HeaderValue(head, "'shape':", '(', ')');
    entries.push_back(std::move(entry));
    at = data + size;
  }
  return entries;
}

}  // namespace

bool IsNpz(const FileStart& file) {
  return file.head.starts_with(kZipEntry) && file.head.find(".npy") < kNpyHead;
}

Description DescribeNpz(const FileStart& file, const ReadRecordingOptions&) {
  std::string text = fmt::format("{}: arrays for NumPy\n", file.path);
  Json arrays = Json::array();
  for (const NpzEntry& entry : ReadNpzEntries(file.path)) {
    text += fmt::format("{:<26} {} {}\n", entry.name, entry.type, entry.shape);
    arrays.push_back({{"name", entry.name}, {"type", entry.type}, {"shape", entry.shape}});
  }
  return {text, FormatJson({{"kind", "arrays"}, {"file", file.path}, {"arrays", arrays}}), {}};
}

bool IsBvh(const FileStart& file) { return Trim(file.head).starts_with(kBvhStart); }

Description DescribeBvh(const FileStart& file, const ReadRecordingOptions&) {
  std::vector<std::string> joints;
  std::string frames = "?";
  std::string frame_time = "?";
  ForEachLine(file.path, [&](std::string_view line) {
    line = Trim(line);
    const auto behind = [&line](std::string_view start, std::string* value) {
      if (!line.starts_with(start)) return false;
      *value = ToUtf8(Trim(line.substr(start.size())));
      return true;
    };
    std::string joint;
    if (behind("ROOT ", &joint) || behind("JOINT ", &joint)) joints.push_back(joint);
    if (!behind("Frames:", &frames)) behind("Frame Time:", &frame_time);
  });
  return {
      fmt::format("{}: skeleton and motion (BVH)\nframes     {}\nframe time {} s\njoints     {}: "
                  "{}\n",
                  file.path, frames, frame_time, joints.size(), FirstNames(joints)),
      FormatJson({{"kind", "skeleton"},
                  {"file", file.path},
                  {"frames", frames},
                  {"frame_time_s", frame_time},
                  {"joints", joints}}),
      {}};
}

}  // namespace mmm_converter
