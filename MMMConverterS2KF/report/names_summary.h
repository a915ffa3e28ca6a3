// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "MMMConverterS2KF/report/json.h"
#include "common/convert/named_markers.h"
#include "common/pipeline/conversion.h"

namespace mmm_converter {

/// "49 of 51 labels by their names; left out: a computed point (LKJC, RKJC)", and a line for each
/// label that is not what its name says.
std::string DescribeNames(const NamedMarkers& named);

/// A line for each label: its landmark, or why it is left out.
std::string FormatNames(const NamedMarkers& named);

/// By label: landmark, marker, and what there is to say.
Json NamesJson(const NamedMarkers& named);

/// The marker set that was used, of names or another one, to be read by --marker-set.
std::string FormatUsedSet(const ConversionPlan& plan);

}  // namespace mmm_converter
