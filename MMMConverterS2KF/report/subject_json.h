// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "common/model/subject.h"

namespace mmm_converter {

/// A subject as JSON, for summaries and the page: name, model, height_m, mass_kg, segments (name,
/// scale, standard_deviation, observability), markers (name, offset_mm, standard_deviation_mm, each
/// x y z, distance_mm, frames, observability) and sources.
std::string FormatSubjectJson(const Subject& subject);

}  // namespace mmm_converter
