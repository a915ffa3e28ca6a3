// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "MMMConverterS2KF/batch/manifest.h"
#include "common/pipeline/option.h"

namespace mmm_converter {

/// The attributes that <Batch>, <Group> and <Recording> may have: all rows that go to the entry.
std::vector<Option> AttributesOf(BatchEntry* entry);

/// Those that <Person> may have: what calibrating asks for.
std::vector<Option> PersonAttributesOf(BatchEntry* entry);

/// What holds for the calibration of a person who stands among recordings.
BatchEntry ForCalibration(const BatchEntry& around);

/// Whether a value is a name as ids are, and no file beside the manifest has it.
bool IsMissingName(const std::string& value, const std::string& folder);

/// Sets what an attribute says; folder: where relative files start. Returns what is expected
/// where it is something else, else nothing.
std::string ReadAttribute(const Option& option, const std::string& value,
                          const std::string& folder);

/// What each attribute is, in lines for people.
std::string DescribeAttributes();

/// What went wrong, and the attribute that helps, where there is one.
std::string WithManifestAdvice(const Error& error);

/// The schema (XSD) of manifests. Whether files are there and ids are unique, only the program can
/// say.
std::string ManifestSchema();

}  // namespace mmm_converter
