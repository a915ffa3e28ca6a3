// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace mmm_converter {

/// Of so many bytes, little-endian; those that are not there are 0.
std::uint64_t IntegerAt(std::string_view bytes, std::size_t at, std::size_t width);

/// What an array of NumPy's says of itself (numpy.lib.format).
struct NumpyHead {
  char type = 'f';          ///< f, i, u or b: numbers; U or S: texts
  std::size_t width = 8;    ///< of an element [bytes]
  bool is_swapped = false;  ///< big-endian
  bool is_fortran = false;  ///< the first axis runs fastest
  std::vector<std::size_t> shape;

  bool is_text() const { return type == 'U' || type == 'S'; }
  std::size_t rows() const { return shape.empty() ? 1 : shape.front(); }
  std::size_t size() const;
  /// Elements of a row: all of the axes behind the first one.
  std::size_t row_size() const { return rows() == 0 ? 0 : size() / rows(); }
};

/// "(120, 22, 3)"
std::string ShapeText(const NumpyHead& head);

/// An array of NumPy's: numbers or text in any order of bytes and axes, by rows of its first axis.
class NumpyArray {
 public:
  const NumpyHead& head() const { return head_; }
  std::size_t rows() const { return head_.rows(); }
  std::size_t row_size() const { return head_.row_size(); }
  /// Of an array of numbers; column: of those that were kept.
  double Number(std::size_t row, std::size_t column) const;
  /// The first text, as far as it is ASCII; of numbers that are bytes, too.
  std::string Text() const;
  /// The elements of its one axis are columns of a row.
  void MakeRow();

 private:
  friend class NumpyReader;

  std::size_t PlaceOf(std::size_t row, std::size_t column) const;

  NumpyHead head_;
  std::size_t kept_ = 0;  ///< columns
  std::string bytes_;
};

/// Makes an array of the bytes of a .npy file as they come.
class NumpyReader {
 public:
  /// file: for messages. most_columns: so many of each row are kept of an array in C order.
  explicit NumpyReader(std::string file,
                       std::size_t most_columns = std::numeric_limits<std::size_t>::max());

  /// @throws Error where it is no array, or one of Python's objects.
  void Add(std::string_view bytes);
  /// @throws Error where bytes are missing.
  NumpyArray Finish();

 private:
  void AddHead();
  [[noreturn]] void Fail(const std::string& what) const;

  std::string file_;
  std::size_t most_columns_;
  std::string start_;  ///< until the head is there
  bool has_head_ = false;
  NumpyArray array_;
  std::size_t row_bytes_ = 0, kept_bytes_ = 0, at_ = 0, left_ = 0;
};

/// One array of NumPy's.
inline bool LooksLikeNpy(std::string_view start) { return start.starts_with("\x93NUMPY"); }

}  // namespace mmm_converter
