// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "MMMConverterS2KF/report/json.h"
#include "common/pipeline/conversion.h"

namespace mmm_converter {

/// Who was recorded, when, how and by what: the head of the page that a clinician prints. Null: the
/// recordings are of an object.
Json PatientJson(const std::vector<const ConversionReport*>& reports);

}  // namespace mmm_converter
