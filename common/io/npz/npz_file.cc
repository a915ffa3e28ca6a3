// SPDX-License-Identifier: MIT
#include "common/io/npz/npz_file.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <memory>
#include <new>

#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

// PKWARE's APPNOTE.TXT 4.3.7, 4.3.12, 4.3.14 to 4.3.16 and 4.5.3.
constexpr std::uint32_t kLocalHeader = 0x04034b50, kCentralHeader = 0x02014b50;
constexpr std::uint32_t kEndOfDirectory = 0x06054b50, kEndOfDirectory64 = 0x06064b50;
constexpr std::size_t kLocalSize = 30, kCentralSize = 46, kEndSize = 22, kEnd64Size = 56;
constexpr std::size_t kLocatorSize = 20, kLongestComment = 65535;
constexpr std::uint64_t kMostMembers = 10'000, kMostDirectory = 1 << 24;
constexpr std::uint64_t kInExtraField = 0xffffffff;
constexpr int kStored = 0, kDeflated = 8;
constexpr std::size_t kPart = 1 << 16;
// Of an array beside its file. Zeros are packed a thousandfold, motions fivefold at most.
constexpr std::uint64_t kMostBytes = 1 << 26, kMostTimes = 16;

std::string NameOf(std::string_view path) {
  if (path.ends_with(".npy")) path.remove_suffix(4);
  return std::string(path);
}

}  // namespace

bool LooksLikeNpz(std::string_view start) {
  return IntegerAt(start, 0, 4) == kLocalHeader && start.size() > kLocalSize &&
         start.substr(kLocalSize, IntegerAt(start, 26, 2)).ends_with(".npy");
}

NpzFile::NpzFile(const std::string& path) : path_(path), source_(BytesOfFile(path)) {
  const std::uint64_t tail_size = std::min<std::uint64_t>(source_.size, kEndSize + kLongestComment);
  const std::uint64_t tail_begin = source_.size - tail_size;
  const std::string tail = Piece(tail_begin, tail_size);
  std::size_t end = tail.size() < kEndSize ? 0 : tail.size() - kEndSize + 1;
  while (end > 0 && IntegerAt(tail, end - 1, 4) != kEndOfDirectory) --end;
  if (end == 0) Fail("has no directory at its end, as archives have that are cut; fetch it again");
  --end;
  std::uint64_t count = IntegerAt(tail, end + 10, 2), size = IntegerAt(tail, end + 12, 4);
  std::uint64_t begin = IntegerAt(tail, end + 16, 4);
  if (begin == kInExtraField || count == 0xffff) {
    if (tail_begin + end < kLocatorSize) Fail("its directory is damaged");
    const std::uint64_t locator = tail_begin + end - kLocatorSize;
    const std::string end64 = Piece(IntegerAt(Piece(locator, kLocatorSize), 8, 8), kEnd64Size);
    if (IntegerAt(end64, 0, 4) != kEndOfDirectory64) Fail("its directory is damaged");
    count = IntegerAt(end64, 32, 8);
    size = IntegerAt(end64, 40, 8);
    begin = IntegerAt(end64, 48, 8);
  }
  if (count > kMostMembers || size > kMostDirectory) {
    Fail(fmt::format("has a directory of {} files in {} bytes; at most {} in {} are read", count,
                     size, kMostMembers, kMostDirectory));
  }
  ReadDirectory(Piece(begin, size), count);
}

void NpzFile::ReadDirectory(std::string_view directory, std::uint64_t count) {
  for (std::uint64_t i = 0; i < count; ++i) {
    if (directory.size() < kCentralSize || IntegerAt(directory, 0, 4) != kCentralHeader) {
      Fail(fmt::format("its directory is damaged at file {} of {}", i + 1, count));
    }
    const std::size_t name_size = IntegerAt(directory, 28, 2);
    const std::size_t extra_size = IntegerAt(directory, 30, 2);
    const std::size_t size = kCentralSize + name_size + extra_size + IntegerAt(directory, 32, 2);
    if (size > directory.size()) Fail("its directory is damaged");
    Member member;
    const bool is_encrypted = (IntegerAt(directory, 8, 2) & 1) != 0;
    member.method = is_encrypted ? -1 : static_cast<int>(IntegerAt(directory, 10, 2));
    member.crc = static_cast<std::uint32_t>(IntegerAt(directory, 16, 4));
    member.packed = IntegerAt(directory, 20, 4);
    member.size = IntegerAt(directory, 24, 4);
    member.offset = IntegerAt(directory, 42, 4);
    const std::string_view extra = directory.substr(kCentralSize + name_size, extra_size);
    for (std::size_t at = 0; at + 4 <= extra.size(); at += 4 + IntegerAt(extra, at + 2, 2)) {
      if (IntegerAt(extra, at, 2) != 1) continue;
      std::size_t field = at + 4;  // of ZIP64, in this order
      for (std::uint64_t* value : {&member.size, &member.packed, &member.offset}) {
        if (*value != kInExtraField) continue;
        *value = IntegerAt(extra, field, 8);
        field += 8;
      }
    }
    members_.emplace(NameOf(directory.substr(kCentralSize, name_size)), member);
    directory.remove_prefix(size);
  }
}

std::vector<std::string> NpzFile::names() const {
  std::vector<std::string> names;
  for (const auto& [name, member] : members_) names.push_back(name);
  return names;
}

std::string NpzFile::NamesForUsers() const {
  std::vector<std::string> shown;
  for (const auto& [name, member] : members_) shown.push_back(ToUtf8(name.substr(0, 100)));
  return FirstNames(shown);
}

std::string NpzFile::FirstOf(const std::vector<std::string>& names) const {
  const auto found =
      std::find_if(names.begin(), names.end(), [&](const std::string& name) { return Has(name); });
  return found == names.end() ? "" : *found;
}

const NpzFile::Member& NpzFile::Find(const std::string& name) const {
  const auto found = members_.find(name);
  if (found != members_.end()) return found->second;
  Fail(fmt::format("has no array {}; it has {}", name, NamesForUsers()));
}

std::string NpzFile::Start(const std::string& name, std::size_t count) const {
  std::string start;
  Unpack(name, Find(name), [&](std::string_view bytes) {
    start += bytes.substr(0, count - start.size());
    return start.size() < count;
  });
  return start;
}

NumpyArray NpzFile::Read(const std::string& name, std::size_t most_columns) const {
  const Member& member = Find(name);
  if (member.size > kMostBytes + kMostTimes * source_.size) {
    Fail(fmt::format("{} would have {:.1f} GB, far more than the file", name,
                     1e-9 * static_cast<double>(member.size)));
  }
  NumpyReader reader(fmt::format("{}: {}", path_, ToUtf8(name)), most_columns);
  Unpack(name, member, [&](std::string_view bytes) {
    reader.Add(bytes);
    return true;
  });
  return reader.Finish();
}

void NpzFile::Unpack(const std::string& name, const Member& member, const Sink& sink) const {
  if (member.method != kStored && member.method != kDeflated) {
    Fail(fmt::format("{} is packed or encrypted in a way that NumPy does not", name));
  }
  const std::string header = Piece(member.offset, kLocalSize);
  if (IntegerAt(header, 0, 4) != kLocalHeader) {
    Fail(fmt::format("{} is not where the directory says", name));
  }
  const std::uint64_t begin =
      member.offset + kLocalSize + IntegerAt(header, 26, 2) + IntegerAt(header, 28, 2);
  if (begin > source_.size || member.packed > source_.size - begin) {
    Fail(fmt::format("{} is cut", name));
  }
  std::uint64_t done = 0;
  uLong crc = 0;
  const auto take = [&](std::string_view bytes) {
    crc = crc32(crc, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size()));
    done += bytes.size();
    return sink(bytes);
  };
  bool is_whole = true;
  if (member.method == kDeflated) {
    is_whole = Inflate(begin, member, take);
  } else {
    for (std::uint64_t at = 0; at < member.packed && is_whole; at += kPart) {
      is_whole = take(Piece(begin + at, std::min<std::uint64_t>(kPart, member.packed - at)));
    }
  }
  if (!is_whole) return;
  if (done != member.size || crc != member.crc) {
    Fail(fmt::format("{} is damaged: {} bytes with the checksum {:08x}; expected {} with {:08x}",
                     name, done, crc, member.size, member.crc));
  }
}

/// Whether the sink took all.
bool NpzFile::Inflate(std::uint64_t begin, const Member& member, const Sink& sink) const {
  z_stream stream = {};
  if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) throw std::bad_alloc();
  const std::unique_ptr<z_stream, int (*)(z_stream*)> guard(&stream, inflateEnd);
  std::string out(kPart, '\0');
  std::uint64_t at = 0, done = 0;
  int result = Z_OK;
  while (result == Z_OK && at < member.packed) {
    std::string in = Piece(begin + at, std::min<std::uint64_t>(kPart, member.packed - at));
    at += in.size();
    stream.next_in = reinterpret_cast<Bytef*>(in.data());
    stream.avail_in = static_cast<uInt>(in.size());
    do {
      stream.next_out = reinterpret_cast<Bytef*>(out.data());
      stream.avail_out = static_cast<uInt>(out.size());
      result = inflate(&stream, Z_NO_FLUSH);
      const std::size_t count = out.size() - stream.avail_out;
      done += count;
      if (done > member.size) return true;  // which is not what the directory says
      if (count > 0 && !sink(std::string_view(out).substr(0, count))) return false;
    } while (result == Z_OK && stream.avail_out == 0);
  }
  return true;
}

std::string NpzFile::Piece(std::uint64_t begin, std::uint64_t count) const {
  if (begin > source_.size || count > source_.size - begin)
    Fail("is cut, or its directory damaged");
  std::string bytes(count, '\0');
  if (count > 0) source_.read(begin, count, bytes.data());
  return bytes;
}

void NpzFile::Fail(const std::string& what) const {
  throw Error(fmt::format("{}: {}", path_, what));
}

}  // namespace mmm_converter
