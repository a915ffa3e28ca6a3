// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "MMMConverterS2KF/report/file_kinds.h"

namespace mmm_converter {

/// What a batch reads and writes: manifests, journals and results.
const std::vector<FileKind>& BatchFileKinds();

}  // namespace mmm_converter
