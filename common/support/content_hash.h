// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace mmm_converter {

/// Tells whether content has changed: XXH3 with 128 bits (Y. Collet, xxHash). No protection against
/// somebody who wants two contents to have the same hash.
class ContentHash {
 public:
  ContentHash();
  ~ContentHash();
  ContentHash(const ContentHash&) = delete;
  ContentHash& operator=(const ContentHash&) = delete;

  void Add(std::string_view bytes);
  /// A part with its length, so that the bounds between parts count too.
  void AddPart(std::string_view bytes);
  std::string Hex() const;  ///< of all that was added: 32 digits

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The hash of a file's bytes.
/// @throws Error where it can't be read.
std::string HashFile(const std::string& path);

}  // namespace mmm_converter
