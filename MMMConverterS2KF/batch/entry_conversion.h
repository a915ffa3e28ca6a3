// SPDX-License-Identifier: MIT
#pragma once

#include <functional>

#include "MMMConverterS2KF/batch/batch_outputs.h"
#include "MMMConverterS2KF/batch/manifest.h"
#include "MMMConverterS2KF/batch/shared_inputs.h"

namespace mmm_converter {

/// Converts an entry; writes nothing. request: the entry's, prepared, and given its outputs.
/// goes_on: asked between frames; false ends it with an Error.
/// @throws Error
ConversionReport ConvertEntry(const BatchEntry& entry, const BatchFolder& folder,
                              ConversionRequest* request, const std::function<bool()>& goes_on);

/// Writes the page of a conversion. @throws WriteError
void WritePage(const BatchEntry& entry, const ConversionReport& report, BatchFolder* folder);

}  // namespace mmm_converter
