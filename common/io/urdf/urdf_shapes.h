// SPDX-License-Identifier: MIT
#pragma once

#include "common/io/urdf/urdf_document.h"
#include "common/io/xml/xml_document.h"
#include "common/support/diagnostics.h"

namespace mmm_converter {

/// Appends the shapes of a `<link>`'s `<collision>` elements, and its meshes, `link` being its
/// index. Damaged ones are left out, with a warning where they would touch.
void AddUrdfShapes(const XmlElement& element, int link, UrdfDocument* document,
                   Diagnostics* diagnostics);

}  // namespace mmm_converter
