// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/pybind11.h>

#include <string>
#include <vector>
#include "common/pipeline/conversion_options.h"
#include "common/pipeline/input/converter_choice.h"
#include "common/pipeline/input/input.h"

namespace mmm_converter::python {

// What the package's functions were called with: a dictionary, in which None is a default. Keys are
// the keywords of tables of options.

/// Reads what is given of a table's rows.
/// @throws Error
void ReadKeywords(const pybind11::dict& options, const std::vector<Option>& table);

/// Options of a request, and its file; or its recording, which has been read.
/// @throws Error as ReadKeywords.
ConversionRequest RequestOf(const pybind11::dict& options);

/// Empty where there is none, or it is None.
std::string TextOf(const pybind11::dict& options, const char* key);

bool IsSet(const pybind11::dict& options, const char* key);

/// The functions that tell the package what keywords there are.
void BindOptions(pybind11::module_* module);

}  // namespace mmm_converter::python
