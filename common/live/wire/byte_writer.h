// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

namespace mmm_converter {

/// Appends values to a message, little endian.
class ByteWriter {
 public:
  explicit ByteWriter(std::string* bytes) : bytes_(bytes) {}

  template <typename T>
  requires std::integral<T> || std::floating_point<T>
  void Put(T value) {
    static_assert(std::endian::native == std::endian::little);
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    bytes_->append(bytes, sizeof(T));
  }

  template <typename T, std::size_t n>
  void PutArray(const T (&values)[n]) {
    for (const T& value : values) Put(value);
  }

  void PutCount(std::size_t count) { Put(static_cast<std::uint32_t>(count)); }

  void PutBytes(std::string_view bytes) { bytes_->append(bytes); }

  /// With a NUL behind it; what follows a NUL within is left out.
  void PutText(std::string_view text) {
    bytes_->append(text.substr(0, text.find('\0')));
    bytes_->push_back('\0');
  }

  /// In a field of so many bytes, at least one of them NUL.
  void PutFixedText(std::string_view text, std::size_t size) {
    text = text.substr(0, size - 1);
    bytes_->append(text).append(size - text.size(), '\0');
  }

  std::size_t size() const { return bytes_->size(); }

  /// Room for a number of bytes that is known later, PutSizeAt.
  std::size_t ReserveSize() {
    PutCount(0);
    return size();
  }

  /// The bytes since `begin`, which ReserveSize returned, and so many more.
  void PutSizeAt(std::size_t begin, std::size_t more = 0) {
    const auto count = static_cast<std::uint32_t>(size() - begin + more);
    std::memcpy(bytes_->data() + begin - sizeof count, &count, sizeof count);
  }

 private:
  std::string* bytes_;
};

}  // namespace mmm_converter
