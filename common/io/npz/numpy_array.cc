// SPDX-License-Identifier: MIT
#include "common/io/npz/numpy_array.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <utility>

#include "common/support/error.h"
#include "common/support/text.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

constexpr std::size_t kLongestHead = 1 << 16;
constexpr std::size_t kMostAxes = 8;
constexpr long kMostElements = 1L << 40;

double FromHalf(std::uint64_t bits) {
  const int exponent = static_cast<int>(bits >> 10 & 0x1f),
            fraction = static_cast<int>(bits & 0x3ff);
  const double sign = (bits & 0x8000) != 0 ? -1 : 1;
  if (exponent == 31) return kNaN;
  if (exponent == 0) return sign * std::ldexp(fraction, -24);
  return sign * std::ldexp(1024 + fraction, exponent - 25);
}

template <typename Number>
double As(std::uint64_t bits) {
  Number number;
  std::memcpy(&number, &bits, sizeof number);  // little-endian, as machines are that this runs on
  return static_cast<double>(number);
}

/// What stands behind a key of a header, which is a dictionary of Python's.
std::string_view ValueOf(std::string_view text, std::string_view key) {
  const std::size_t at = text.find(fmt::format("'{}':", key));
  return at == std::string_view::npos ? "" : Trim(text.substr(at + key.size() + 3));
}

/// Empty: it is right; else what is wrong.
std::string ReadType(std::string_view text, NumpyHead* head) {
  const std::string_view value = ValueOf(text, "descr");
  const std::size_t end = value.find('\'', 1);
  if (!value.starts_with('\'') || end == std::string_view::npos) {
    return "is an array of records; expected numbers";
  }
  const std::string_view all = value.substr(1, end - 1);
  std::string_view type = all;
  if (type.find('O') != std::string_view::npos) {
    return "is an array of Python's objects, which are not opened; save it as numbers";
  }
  head->is_swapped = type.starts_with('>');
  if (!type.empty() && std::string_view("<>|=").find(type[0]) != std::string_view::npos) {
    type.remove_prefix(1);
  }
  head->type = type.empty() ? ' ' : type[0];
  const long width = ParseLong(type.empty() ? type : type.substr(1)).value_or(0);
  const auto is = [&](std::string_view types, std::initializer_list<long> widths) {
    return types.find(head->type) != std::string_view::npos &&
           std::find(widths.begin(), widths.end(), width) != widths.end();
  };
  const bool is_text = head->is_text() && width >= 0 && width < 10'000;
  if (!is_text && !is("f", {2, 4, 8}) && !is("iu", {1, 2, 4, 8}) && !is("b", {1})) {
    return fmt::format("has elements of the type \"{}\"; expected numbers",
                       ToUtf8(all.substr(0, 40)));
  }
  head->width = static_cast<std::size_t>(width) * (head->type == 'U' ? 4 : 1);
  return "";
}

bool ReadShape(std::string_view text, NumpyHead* head) {
  const std::string_view value = ValueOf(text, "shape");
  const std::size_t end = value.find(')');
  if (!value.starts_with('(') || end == std::string_view::npos) return false;
  long size = 1;
  for (const std::string& axis : Split(value.substr(1, end - 1), ',')) {
    if (Trim(axis).empty()) continue;
    const std::optional<long> length = ParseLong(Trim(axis));
    if (!length || *length < 0 || *length > kMostElements || head->shape.size() == kMostAxes) {
      return false;
    }
    if (*length > 0 && size > kMostElements / *length) return false;
    size *= *length;
    head->shape.push_back(static_cast<std::size_t>(*length));
  }
  return true;
}

}  // namespace

std::uint64_t IntegerAt(std::string_view bytes, std::size_t at, std::size_t width) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < width && at + i < bytes.size(); ++i) {
    value |= static_cast<std::uint64_t>(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
  }
  return value;
}

std::size_t NumpyHead::size() const {
  std::size_t size = 1;
  for (const std::size_t length : shape) size *= length;
  return size;
}

std::string ShapeText(const NumpyHead& head) {
  return fmt::format("({}{})", fmt::join(head.shape, ", "), head.shape.size() == 1 ? "," : "");
}

std::size_t NumpyArray::PlaceOf(std::size_t row, std::size_t column) const {
  if (!head_.is_fortran) return row * kept_ + column;
  std::size_t i = row * row_size() + column, place = 0, stride = head_.size();
  for (std::size_t axis = head_.shape.size(); axis-- > 0;) {
    const std::size_t length = head_.shape[axis];
    stride /= length;
    place += i % length * stride;
    i /= length;
  }
  return place;
}

void NumpyArray::MakeRow() {
  head_.shape.insert(head_.shape.begin(), 1);
  kept_ = row_size();
}

double NumpyArray::Number(std::size_t row, std::size_t column) const {
  const std::size_t width = head_.width;
  std::uint64_t bits = 0;
  const char* const at = bytes_.data() + PlaceOf(row, column) * width;
  for (std::size_t i = 0; i < width; ++i) {
    const std::size_t from = head_.is_swapped ? width - 1 - i : i;
    bits |= static_cast<std::uint64_t>(static_cast<unsigned char>(at[from])) << (8 * i);
  }
  if (head_.type == 'f') {
    return width == 2 ? FromHalf(bits) : width == 4 ? As<float>(bits) : As<double>(bits);
  }
  if (head_.type != 'i') return static_cast<double>(bits);
  return width == 1   ? As<std::int8_t>(bits)
         : width == 2 ? As<std::int16_t>(bits)
         : width == 4 ? As<std::int32_t>(bits)
                      : As<std::int64_t>(bits);
}

std::string NumpyArray::Text() const {
  std::string text;
  const std::size_t end = head_.is_text() ? std::min(head_.width, bytes_.size()) : bytes_.size();
  for (std::size_t i = 0; i < end; ++i) {
    if (bytes_[i] > ' ') text += bytes_[i];
  }
  return text;
}

NumpyReader::NumpyReader(std::string file, std::size_t most_columns)
    : file_(std::move(file)), most_columns_(most_columns) {}

void NumpyReader::Fail(const std::string& what) const {
  throw Error(fmt::format("{}: {}", file_, what));
}

void NumpyReader::AddHead() {
  constexpr std::size_t kMagic = 8;  // with the version
  if (start_.size() < kMagic) return;
  if (!LooksLikeNpy(start_)) Fail("is no array of NumPy's (.npy)");
  const std::size_t width = start_[6] == 1 ? 2 : 4;
  if (start_.size() < kMagic + width) return;
  const std::uint64_t length = IntegerAt(start_, kMagic, width);
  if (length > kLongestHead) Fail(fmt::format("says that its header has {} bytes", length));
  const std::size_t begin = kMagic + width + length;
  if (start_.size() < begin) return;
  const std::string_view text = std::string_view(start_).substr(kMagic + width, length);
  NumpyHead& head = array_.head_;
  if (const std::string wrong = ReadType(text, &head); !wrong.empty()) Fail(wrong);
  if (!ReadShape(text, &head)) Fail("says no shape of the array that can be");
  head.is_fortran = ValueOf(text, "fortran_order").starts_with("True");
  array_.kept_ = head.is_fortran || head.shape.size() < 2
                     ? head.row_size()
                     : std::min(head.row_size(), most_columns_);
  row_bytes_ = head.row_size() * head.width;
  kept_bytes_ = array_.kept_ * head.width;
  left_ = head.size() * head.width;
  has_head_ = true;
  const std::string rest = start_.substr(begin);
  start_.clear();
  Add(rest);
}

void NumpyReader::Add(std::string_view bytes) {
  if (!has_head_) {
    start_ += bytes;
    AddHead();
    return;
  }
  bytes = bytes.substr(0, left_);
  left_ -= bytes.size();
  if (kept_bytes_ == row_bytes_) {
    array_.bytes_ += bytes;
    return;
  }
  while (!bytes.empty()) {
    const std::size_t count = std::min(bytes.size(), row_bytes_ - at_);
    if (at_ < kept_bytes_) array_.bytes_ += bytes.substr(0, std::min(count, kept_bytes_ - at_));
    at_ = (at_ + count) % row_bytes_;
    bytes.remove_prefix(count);
  }
}

NumpyArray NumpyReader::Finish() {
  if (!has_head_) Fail("is cut in the header of the array");
  if (left_ > 0) {
    Fail(fmt::format("is cut: of an array of the shape {} the last {} bytes are not there",
                     ShapeText(array_.head_), left_));
  }
  return std::move(array_);
}

}  // namespace mmm_converter
