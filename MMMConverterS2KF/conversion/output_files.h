// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace mmm_converter {

/// Before `output` is written.
/// @throws Error where it is one of the files that are read.
void CheckIsNoInput(const std::string& output, const std::vector<std::string>& inputs);

/// Before the work whose result they hold: whether the system would let them be written, as far as
/// can be told. An empty path can.
/// @throws WriteError
void CheckCanBeWritten(const std::string& output);

/// Before they are written; empty paths, devices and pipes are left out.
/// @throws Error where two are the same file.
void CheckAreDifferentFiles(const std::vector<std::string>& outputs);

}  // namespace mmm_converter
