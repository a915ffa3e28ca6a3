// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/pybind11.h>

#include "common/pipeline/input/converter_choice.h"
#include "common/pipeline/input/input.h"

namespace mmm_converter::python {

// What the package's functions were called with: a dictionary, in which None is a default. Keys are
// the keywords of the package.

/// file, unit, up, rate, ignore_residuals, prefix, motion, frames, model, marker_set, height, mass,
/// hand_length, person, subject_file.
/// @throws Error
InputRequest InputRequestOf(const pybind11::dict& options);

/// config, converter, plugin.
ConverterRequest ConverterRequestOf(const pybind11::dict& options);

/// Empty where there is none, or it is None.
std::string TextOf(const pybind11::dict& options, const char* key);

bool IsSet(const pybind11::dict& options, const char* key);

}  // namespace mmm_converter::python
