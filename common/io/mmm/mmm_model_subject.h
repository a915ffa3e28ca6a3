// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "common/model/subject.h"

namespace mmm_converter {

/// The text of a reference model's file, changed so that any MMM program that scales it by the
/// subject's ModelProcessorConfig has FitToSubject's model: translations, centres of mass, inertia
/// and marker places of the named segments and markers, in the file's units, with 10 digits. Every
/// other byte stays; a comment before the root says whose model it is. `file` is only named in
/// messages.
/// @throws Error where it is not a model, or not one that has the subject's names.
std::string FormatSubjectModel(const std::string& model_xml, const std::string& file,
                               const Subject& subject);

/// Of a file; as FormatSubjectModel.
std::string ReadModelForSubject(const std::string& model_file, const Subject& subject);

}  // namespace mmm_converter
