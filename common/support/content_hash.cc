// SPDX-License-Identifier: MIT
#include "common/support/content_hash.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <vector>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include "common/support/error.h"

namespace mmm_converter {

struct ContentHash::State {
  XXH3_state_t hash;
};

ContentHash::ContentHash() : state_(std::make_unique<State>()) {
  XXH3_128bits_reset(&state_->hash);
}

ContentHash::~ContentHash() = default;

void ContentHash::Add(std::string_view bytes) {
  XXH3_128bits_update(&state_->hash, bytes.data(), bytes.size());
}

void ContentHash::AddPart(std::string_view bytes) {
  Add(fmt::format("{}:", bytes.size()));
  Add(bytes);
}

std::string ContentHash::Hex() const {
  const XXH128_hash_t digest = XXH3_128bits_digest(&state_->hash);
  return fmt::format("{:016x}{:016x}", digest.high64, digest.low64);
}

std::string HashFile(const std::string& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) throw Error(fmt::format("{}: can't be read: {}", path, std::strerror(errno)));
  ContentHash hash;
  std::vector<char> buffer(std::size_t{1} << 18);
  ssize_t count = 0;
  do {
    count = ::read(file, buffer.data(), buffer.size());
    if (count > 0) hash.Add({buffer.data(), static_cast<std::size_t>(count)});
  } while (count > 0 || (count < 0 && errno == EINTR));
  const int failure = errno;
  ::close(file);
  if (count < 0) throw Error(fmt::format("{}: can't be read: {}", path, std::strerror(failure)));
  return hash.Hex();
}

}  // namespace mmm_converter
