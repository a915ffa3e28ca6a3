// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "common/model/kinematic_model.h"
#include "common/model/subject.h"
#include "common/support/warnings.h"

namespace mmm_converter {

// What a calibration knows of a model beyond the model itself stands in a comment behind the root.
// OpenSim passes it over, and leaves it out when it saves the model, which may be another one then.

/// The text with how well the subject's markers and joints are known, in place of what it says of
/// that. model: of the text. program: as FormatSubject.
std::string WithOsimSubject(std::string_view content, const KinematicModel& model,
                            const Subject& subject, const std::string& program);

/// The text without that comment.
std::string WithoutOsimSubject(std::string_view content);

/// What the comment says of markers that are where it has them, and of joints that there are, as a
/// subject that changes nothing of the model (offsets 0). Null: it says nothing, or can't be read,
/// of which it warns. model: of the text.
std::shared_ptr<const Subject> ParseOsimSubject(std::string_view content, const std::string& file,
                                                const KinematicModel& model, Warnings* warnings);

}  // namespace mmm_converter
