// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>

#include "common/io/xml/xml_document.h"

namespace mmm_converter {

/// How many recordings a manifest has.
/// @throws Error where they, with what they take over from their groups, would take much more
/// memory than the file of so many bytes.
std::size_t CountRecordings(const XmlElement& manifest, std::size_t file_bytes,
                            const std::string& file);

}  // namespace mmm_converter
