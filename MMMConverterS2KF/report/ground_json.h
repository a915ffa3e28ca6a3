// SPDX-License-Identifier: MIT
#pragma once

#include "MMMConverterS2KF/report/json.h"
#include "common/contacts/contacts.h"
#include "common/pipeline/conversion.h"

namespace mmm_converter {

/// What the page draws of the ground under a person: force plates, and at each of the DrawnFrames
/// their forces on the person [N] and centres of pressure [m]; `gait`. Null: nothing is known of
/// it.
Json GroundJson(const ConversionReport& report);

/// When which foot stands, as --export-contacts has it; null: not within what was recorded.
Json StancesJson(const FootContacts& contacts);

}  // namespace mmm_converter
