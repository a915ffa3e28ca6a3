// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <string>

#include "common/convert/tracking_setup.h"
#include "common/io/model_file.h"
#include "common/io/recording/recording.h"
#include "common/pipeline/finished_work.h"
#include "common/support/warnings.h"

namespace mmm_converter::python {

/// A recording as it was read, or made of arrays.
struct ReadRecordingResult {
  std::shared_ptr<const Recording> recording;
  Warnings warnings;
  std::string path = {};  ///< absolute, of the file; empty: of arrays
};

/// A model scaled to a person.
struct PersonModel {
  std::string file;
  std::shared_ptr<const LoadedModel> loaded;
  PersonScaling scaling;
  std::shared_ptr<const KinematicModel> model;  ///< scaled
};

/// A conversion, and how it was asked for.
using Conversion = FinishedConversion;

// Each binds the classes and functions of a source.
void BindRecordings(pybind11::module_* module);
void BindModels(pybind11::module_* module);
void BindConversions(pybind11::module_* module);
void BindStudies(pybind11::module_* module);
void BindLive(pybind11::module_* module);

}  // namespace mmm_converter::python
