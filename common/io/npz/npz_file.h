// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "common/io/bytes/file_content.h"
#include "common/io/npz/numpy_array.h"

namespace mmm_converter {

/// An archive whose first file is an array of NumPy's.
bool LooksLikeNpz(std::string_view start);

/// A .npz file: a ZIP archive (also ZIP64) of .npy files, stored or deflated. Nothing is ever
/// written to a path of the archive.
class NpzFile {
 public:
  /// Reads the directory. @throws Error where it is damaged.
  explicit NpzFile(const std::string& path);

  std::vector<std::string> names() const;  ///< of the arrays, sorted; in any bytes
  std::string NamesForUsers() const;       ///< some of them
  bool Has(const std::string& name) const { return members_.contains(name); }
  /// The first of these names that is there; empty: none is.
  std::string FirstOf(const std::vector<std::string>& names) const;
  /// The first bytes of an array's file. @throws Error as Read.
  std::string Start(const std::string& name, std::size_t count) const;
  /// Unpacked and checked; most_columns: as NumpyReader.
  /// @throws Error where there is no such array, it is damaged, or far larger than the file.
  NumpyArray Read(const std::string& name,
                  std::size_t most_columns = std::numeric_limits<std::size_t>::max()) const;

 private:
  struct Member {
    std::uint64_t offset = 0, packed = 0, size = 0;
    std::uint32_t crc = 0;
    int method = 0;
  };
  using Sink = std::function<bool(std::string_view)>;  ///< false: no more

  void ReadDirectory(std::string_view directory, std::uint64_t count);
  std::string Piece(std::uint64_t begin, std::uint64_t count) const;
  const Member& Find(const std::string& name) const;
  void Unpack(const std::string& name, const Member& member, const Sink& sink) const;
  bool Inflate(std::uint64_t begin, const Member& member, const Sink& sink) const;
  [[noreturn]] void Fail(const std::string& what) const;

  std::string path_;
  ByteSource source_;
  std::map<std::string, Member> members_;
};

}  // namespace mmm_converter
