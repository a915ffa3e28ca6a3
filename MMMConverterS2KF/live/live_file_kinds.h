// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "MMMConverterS2KF/report/file_kinds.h"

namespace mmm_converter {

/// What live tracking leaves behind: journals, with how their motion is recovered.
const std::vector<FileKind>& LiveFileKinds();

}  // namespace mmm_converter
