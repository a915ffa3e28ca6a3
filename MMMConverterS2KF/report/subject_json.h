// SPDX-License-Identifier: MIT
#pragma once

#include "MMMConverterS2KF/report/json.h"
#include "common/model/subject.h"

namespace mmm_converter {

/// A calibrated person, for summaries and the page; README.md says what is in it.
Json ToJson(const Subject& subject);

}  // namespace mmm_converter
