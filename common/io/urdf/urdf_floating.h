// SPDX-License-Identifier: MIT
#pragma once

#include "common/io/urdf/urdf_document.h"

namespace mmm_converter {

/// Where the root is a link without mass that only carries the next one by a floating joint, that
/// one becomes the root: the joint's origin is a start pose only.
void RemoveFloatingWorld(UrdfDocument* document);

}  // namespace mmm_converter
