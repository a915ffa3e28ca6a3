// SPDX-License-Identifier: MIT
#include "common/io/tables/npz_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <limits>

#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are written as they lie");

// ZIP: PKWARE's APPNOTE.TXT 4.3.7, 4.3.12 and 4.3.16; without ZIP64.
constexpr std::uint32_t kLocalHeader = 0x04034b50;
constexpr std::uint32_t kCentralHeader = 0x02014b50;
constexpr std::uint32_t kEndOfDirectory = 0x06054b50;
constexpr std::uint16_t kZipVersion = 20;        // to read it: 2.0
constexpr std::uint16_t kNoDate = (1 << 5) | 1;  // 1980-01-01
constexpr std::size_t kArrayAlignment = 64;      // of the numbers behind a .npy header

template <typename Integer>
void AppendInteger(Integer value, std::string* out) {
  for (std::size_t i = 0; i < sizeof value; ++i) {
    *out += static_cast<char>(static_cast<std::uint64_t>(value) >> (8 * i) & 0xff);
  }
}

std::array<std::uint32_t, 256> CrcTable() {
  std::array<std::uint32_t, 256> table = {};
  for (std::uint32_t i = 0; i < table.size(); ++i) {
    std::uint32_t c = i;
    for (int bit = 0; bit < 8; ++bit) c = (c & 1) != 0 ? 0xedb88320U ^ (c >> 1) : c >> 1;
    table[i] = c;
  }
  return table;
}

std::uint32_t Crc32(std::string_view bytes) {
  static const std::array<std::uint32_t, 256> kTable = CrcTable();
  std::uint32_t crc = 0xffffffffU;
  for (const char byte : bytes) {
    crc = kTable[(crc ^ static_cast<unsigned char>(byte)) & 0xff] ^ (crc >> 8);
  }
  return ~crc;
}

std::u32string CodePoints(std::string_view raw) {
  const std::string text = ToUtf8(raw);
  std::u32string points;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length =
        std::max<std::size_t>(Utf8Length(std::string_view(text).substr(i)), 1);
    const auto first = static_cast<unsigned char>(text[i]);
    char32_t point = length == 1 ? first : first & (0x7fU >> length);
    for (std::size_t j = 1; j < length; ++j) {
      point = point << 6 | (static_cast<unsigned char>(text[i + j]) & 0x3fU);
    }
    points += point;
    i += length;
  }
  return points;
}

std::string TypeAndBytes(const NpyArray& array, std::string* bytes) {
  if (!array.integers.empty()) {
    bytes->assign(reinterpret_cast<const char*>(array.integers.data()),
                  array.integers.size() * sizeof(std::int64_t));
    return "<i8";
  }
  if (array.texts.empty()) {
    bytes->assign(reinterpret_cast<const char*>(array.numbers.data()),
                  array.numbers.size() * sizeof(double));
    return "<f8";
  }
  std::vector<std::u32string> texts;
  std::size_t width = 1;
  for (const std::string& text : array.texts) {
    texts.push_back(CodePoints(text));
    width = std::max(width, texts.back().size());
  }
  for (std::u32string& text : texts) {
    text.resize(width, U'\0');
    for (const char32_t point : text) AppendInteger(static_cast<std::uint32_t>(point), bytes);
  }
  return fmt::format("<U{}", width);
}

// Of a file in the archive, as both of its headers have it.
std::string EntryFields(std::string_view name, std::uint32_t crc, std::uint32_t size) {
  std::string fields;
  AppendInteger(kZipVersion, &fields);
  AppendInteger(std::uint16_t{0}, &fields);  // flags
  AppendInteger(std::uint16_t{0}, &fields);  // stored
  AppendInteger(std::uint16_t{0}, &fields);  // time
  AppendInteger(kNoDate, &fields);
  AppendInteger(crc, &fields);
  AppendInteger(size, &fields);  // compressed
  AppendInteger(size, &fields);
  AppendInteger(static_cast<std::uint16_t>(name.size()), &fields);
  AppendInteger(std::uint16_t{0}, &fields);  // extra field
  return fields;
}

void AppendToDirectory(std::string_view name, const std::string& fields, std::uint32_t offset,
                       std::string* directory) {
  AppendInteger(kCentralHeader, directory);
  AppendInteger(kZipVersion, directory);  // that made it
  *directory += fields;
  AppendInteger(std::uint16_t{0}, directory);  // comment
  AppendInteger(std::uint16_t{0}, directory);  // disk
  AppendInteger(std::uint16_t{0}, directory);  // internal attributes
  AppendInteger(std::uint32_t{0}, directory);  // external attributes
  AppendInteger(offset, directory);
  *directory += name;
}

std::string EndOfDirectory(std::size_t entries, std::size_t directory_size, std::size_t offset) {
  std::string end;
  AppendInteger(kEndOfDirectory, &end);
  AppendInteger(std::uint32_t{0}, &end);  // disks
  AppendInteger(static_cast<std::uint16_t>(entries), &end);
  AppendInteger(static_cast<std::uint16_t>(entries), &end);
  AppendInteger(static_cast<std::uint32_t>(directory_size), &end);
  AppendInteger(static_cast<std::uint32_t>(offset), &end);
  AppendInteger(std::uint16_t{0}, &end);  // comment
  return end;
}

void CheckSize(const std::vector<NpyArray>& arrays) {
  constexpr std::size_t kOverhead = 4096;  // of an array, with its headers
  std::size_t bytes = 0;
  for (const NpyArray& array : arrays) {
    bytes += kOverhead + (array.numbers.size() + array.integers.size()) * sizeof(double);
    for (const std::string& text : array.texts) bytes += 4 * text.size();
  }
  if (bytes < std::numeric_limits<std::uint32_t>::max()) return;
  throw Error(
      fmt::format("the arrays have {:.1f} GB, and a .npz file has room for 4; write fewer frames "
                  "or fewer segments",
                  1e-9 * static_cast<double>(bytes)));
}

}  // namespace

std::string FormatNpy(const NpyArray& array) {
  std::string bytes;
  const std::string type = TypeAndBytes(array, &bytes);
  std::string shape;
  for (const std::int64_t size : array.shape) shape += fmt::format("{}, ", size);
  if (array.shape.size() > 1) shape.resize(shape.size() - 2);
  if (array.shape.size() == 1) shape.resize(shape.size() - 1);
  std::string header =
      fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}), }}", type, shape);
  constexpr std::size_t kStart = 10;  // magic, version and the header's length
  const std::size_t end = kStart + header.size() + 1;
  header.append((kArrayAlignment - end % kArrayAlignment) % kArrayAlignment, ' ');
  header += '\n';
  std::string file = "\x93NUMPY";
  file += '\x01';
  file += '\x00';
  AppendInteger(static_cast<std::uint16_t>(header.size()), &file);
  return file + header + bytes;
}

TextPieces FormatNpz(const std::vector<NpyArray>& arrays) {
  CheckSize(arrays);
  return [&arrays](const TextSink& sink) {
    std::string directory;
    std::size_t offset = 0;
    for (const NpyArray& array : arrays) {
      const std::string name = array.name + ".npy";
      const std::string file = FormatNpy(array);
      const std::string fields =
          EntryFields(name, Crc32(file), static_cast<std::uint32_t>(file.size()));
      std::string header;
      AppendInteger(kLocalHeader, &header);
      header += fields + name;
      AppendToDirectory(name, fields, static_cast<std::uint32_t>(offset), &directory);
      sink(header);
      sink(file);
      offset += header.size() + file.size();
    }
    sink(directory);
    sink(EndOfDirectory(arrays.size(), directory.size(), offset));
  };
}

}  // namespace mmm_converter
