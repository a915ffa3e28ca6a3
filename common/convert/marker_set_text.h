// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "common/convert/marker_set.h"

namespace mmm_converter {

/// A marker set's file for people to read and change (xml_config/schema/marker_set.xsd): places in
/// mm with one decimal. remarks: by place, what stands beside it; may be empty. head, tail:
/// comments at the beginning and at the end; empty: none. Pairs of a label with a marker of that
/// name are not written where the set places the marker: the reader adds them.
std::string FormatMarkerSet(const MarkerSet& set, const std::string& head,
                            const std::vector<std::string>& remarks,
                            const std::vector<std::string>& tail);

}  // namespace mmm_converter
