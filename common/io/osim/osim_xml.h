// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "common/io/xml/xml_document.h"

namespace mmm_converter {

/// The content up to the end of its first element; all of it where that does not end.
std::string_view FirstElement(std::string_view content);

/// By the name of its root.
bool IsOsimDocument(std::string_view content);
/// Whether it may be a file of that set: its root is the set or OpenSim's.
bool IsOsimPart(std::string_view content, const char* set);

/// As ParseXml, of what OpenSim reads: whatever stands behind the root's end is passed over. The
/// root is `<OpenSimDocument>`.
/// @throws Error as ParseXml, and for another root.
XmlElement ParseOsimXml(std::string_view content, const std::string& file);

/// @throws Error for a version whose layout is not read.
int ReadOsimVersion(const XmlElement& root, const std::string& file);

/// The set of that name in a file of its own, as the root or in OpenSim's root. @throws Error as
/// ParseOsimXml, and where there is none.
XmlElement ParseOsimPart(std::string_view content, const std::string& file, const char* set);

}  // namespace mmm_converter
