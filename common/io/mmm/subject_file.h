// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "common/model/kinematic_model.h"
#include "common/model/subject.h"

namespace mmm_converter {

/// A subject as XML (`<Subject>`, xml_config/schema/subject.xsd): lengths in mm with 4 decimals,
/// everything else with 6, without trailing zeros; reading that back and writing it again gives the
/// same bytes. Observability and the program are written for people and not read. program: what
/// estimated the subject, e.g. "MMMConverterS2KF 1.0.0".
std::string FormatSubject(const Subject& subject, const std::string& program);

/// Reads a subject of the (unscaled) reference model, whose names it must have. leaves_others:
/// markers that the model does not have are passed over, as where each recording has its own.
/// @throws Error with all errors of the file: what is not well-formed, unknown, repeated or outside
/// of what a body has, and a subject of another model.
Subject ReadSubject(const std::string& path, const KinematicModel& reference,
                    bool leaves_others = false);

/// As ReadSubject, from text; `file` is only named in messages.
Subject ParseSubject(const std::string& xml, const std::string& file,
                     const KinematicModel& reference, bool leaves_others = false);

}  // namespace mmm_converter
