// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace mmm_converter::testing {

/// Whether a file is valid by a schema: one of xml_config/schema, "marker_set.xsd", or a whole
/// path. xmllint's reasons go to the test's output.
bool IsValidFile(const std::string& schema, const std::string& file);

/// The same for text.
bool IsValidText(const std::string& schema, const std::string& xml);

}  // namespace mmm_converter::testing
