// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "MMMConverterS2KF/live/motion_journal.h"

namespace mmm_converter {

/// The first line of a journal: JSON.
std::string FormatJournalHeader(const JournalHeader& header);

}  // namespace mmm_converter
