// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "MMMConverterS2KF/batch/manifest.h"

namespace mmm_converter {

/// An attribute that <Batch>, <Group> and <Recording> may have.
struct ManifestAttribute {
  std::string name;
  std::string help;
  /// Takes a value over; folder: where relative files start. Returns what is allowed where the
  /// value is not, else nothing.
  std::function<std::string(const std::string& value, const std::string& folder,
                            BatchEntry* settings)>
      apply;
};

const std::vector<ManifestAttribute>& ManifestAttributes();

}  // namespace mmm_converter
