// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>

namespace mmm_converter::testing {

/// Writes a manifest of `count` entries, "0", "1", ..., parts of 40 frames of the sample recording
/// in TestFolder(); more: entries as XML. attributes: of <Batch>. Returns its file.
std::string WriteManifest(int count, const std::string& attributes, const std::string& more = "");

/// Attributes that convert with the TestConverter, which is quick.
std::string QuickConverter();

/// All files below a folder with their contents.
std::map<std::string, std::string> Contents(const std::string& folder);

}  // namespace mmm_converter::testing
