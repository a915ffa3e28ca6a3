// SPDX-License-Identifier: MIT
#pragma once

#include "common/support/error.h"

namespace mmm_converter {

/// Bytes that are no message of the protocol: "byte 57: ...". A source counts them and goes on.
class BrokenMessage : public Error {
 public:
  using Error::Error;
  ~BrokenMessage() override;
};

}  // namespace mmm_converter
