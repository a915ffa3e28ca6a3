// SPDX-License-Identifier: MIT
#include "common/live/wire/broken_message.h"

namespace mmm_converter {

BrokenMessage::~BrokenMessage() = default;

}  // namespace mmm_converter
