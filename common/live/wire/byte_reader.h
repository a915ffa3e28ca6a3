// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "common/live/wire/broken_message.h"

namespace mmm_converter {

static_assert(std::endian::native == std::endian::little, "messages are little endian");

/// Takes one value after the other from a message, little endian. Nothing is read past its end.
/// @throws BrokenMessage, all that take.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}

  template <typename T>
  requires std::integral<T> || std::floating_point<T> T Take() {
    Need(sizeof(T));
    T value;
    std::memcpy(&value, bytes_.data() + at_, sizeof(T));
    at_ += sizeof(T);
    return value;
  }

  template <typename T, std::size_t n>
  void TakeArray(T (&values)[n]) {
    for (T& value : values) value = Take<T>();
  }

  std::string_view TakeBytes(std::size_t count) {
    Need(count);
    at_ += count;
    return bytes_.substr(at_ - count, count);
  }

  /// Up to a NUL, which is taken too.
  std::string_view TakeText() {
    const std::size_t end = bytes_.find('\0', at_);
    if (end == std::string_view::npos) Fail("a text without an end");
    const std::string_view text = bytes_.substr(at_, end - at_);
    at_ = end + 1;
    return text;
  }

  /// The number of elements that follow, of which each has so many bytes at least: what a message
  /// makes its reader allocate is bounded by its length.
  std::size_t TakeCount(std::size_t least_bytes) {
    const std::size_t where = at_;
    const auto count = Take<std::uint32_t>();
    if (count > left() / least_bytes) {
      at_ = where;
      Fail("a count of " + std::to_string(count) + ", for which the message is too short");
    }
    return count;
  }

  /// @param at not behind the end
  void GoTo(std::size_t at) { at_ = at; }

  std::size_t at() const { return at_; }
  std::size_t left() const { return bytes_.size() - at_; }

  /// @throws BrokenMessage where bytes are left.
  void ExpectEnd() const {
    if (left() > 0) Fail(std::to_string(left()) + " more bytes than its contents have");
  }

  [[noreturn]] void Fail(const std::string& what) const {
    throw BrokenMessage("byte " + std::to_string(at_) + ": " + what);
  }

 private:
  void Need(std::size_t count) const {
    if (count > left()) {
      Fail("the message ends after " + std::to_string(left()) + " bytes; " + std::to_string(count) +
           " are expected");
    }
  }

  std::string_view bytes_;
  std::size_t at_ = 0;
};

}  // namespace mmm_converter
