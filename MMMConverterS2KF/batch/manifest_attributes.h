// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "MMMConverterS2KF/batch/manifest.h"

namespace mmm_converter {

/// An attribute that <Batch>, <Group> and <Recording> may have.
struct ManifestAttribute {
  const char* name;
  const char* help;
  /// Takes a value over; folder: where relative files start. Returns what is allowed where the
  /// value is not, else nothing.
  std::string (*apply)(const std::string& value, const std::string& folder, BatchEntry* settings);
};

const std::vector<ManifestAttribute>& ManifestAttributes();

}  // namespace mmm_converter
