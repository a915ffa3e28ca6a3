// SPDX-License-Identifier: MIT
#pragma once

#include "common/support/advice.h"

namespace mmm_converter::python {

/// Messages name the keywords of the package's functions.
Wording KeywordWording();

}  // namespace mmm_converter::python
