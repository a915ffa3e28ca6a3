// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "common/io/tables/marker_rows.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// True if text can be a CSV export of OptiTrack Motive (from 1.10 on): it starts with
/// "Format Version".
bool LooksLikeMotiveCsv(std::string_view content);

/// The markers of a CSV export of OptiTrack Motive. The first line has keys and values ("Export
/// Frame Rate", "Length Units", ...); then a row each says of a column its type, name, ID, in newer
/// versions parent, and whether it is of a rotation or a position; older versions leave out what
/// the rows are:
///
///     ,Type,Marker,Marker,Marker,Bone,...
///     ,Name,Ann:LASI,Ann:LASI,Ann:LASI,Ann:Hip,...
///     ,,Position,Position,Position,Rotation,...
///     Frame,Time (Seconds),X,Y,Z,X,...
///
/// Of a marker that is there as measured and as the solver has it, the measured one counts. Those
/// called "Unlabeled" get the label `*` and what follows.
/// @throws Error where there are no markers, and as ReadMarkerRows.
MarkerTable ParseMotiveCsv(std::string_view content, const std::string& file,
                           Warnings* warnings = nullptr);

}  // namespace mmm_converter
