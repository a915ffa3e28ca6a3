// SPDX-License-Identifier: MIT
#include "common/support/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

namespace mmm_converter {

Error::Error(const std::string& message, Remedy remedy)
    : std::runtime_error(message), remedy_(remedy) {}
Error::~Error() = default;

WriteError::WriteError(const std::string& path, int error_number)
    : Error(fmt::format("{}: can't be written: {}", path, std::strerror(error_number))),
      error_number_(error_number) {}

bool WriteError::concerns_disk() const {
  constexpr std::array kOfDisk = {ENOSPC, EDQUOT, EROFS, EIO, ESTALE, ENXIO, ENODEV, ENOTCONN};
  return std::find(kOfDisk.begin(), kOfDisk.end(), error_number_) != kOfDisk.end();
}

}  // namespace mmm_converter
