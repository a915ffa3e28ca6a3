// SPDX-License-Identifier: MIT
#pragma once

namespace mmm_converter {

/// This thread may run wherever the program's first one may, also where the thread that began it
/// keeps to one processor. Does nothing where the system does not say.
void UseAnyProcessor();

}  // namespace mmm_converter
