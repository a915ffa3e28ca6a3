// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "common/io/osim/osim_document.h"
#include "common/io/xml/xml_document.h"

namespace mmm_converter {

/// Reads a joint of either layout, but for the frames, and appends its coordinates to the
/// document's. @throws nothing; errors are of the diagnostics.
OsimJoint ReadOsimJoint(const XmlElement& element, OsimDocument* document,
                        Diagnostics* diagnostics);

/// Whether an element is a joint of a kind that is not read: "ScapulothoracicJoint".
bool IsOsimJointName(std::string_view name);

}  // namespace mmm_converter
