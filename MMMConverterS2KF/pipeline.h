// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "MMMConverterS2KF/converter_choice.h"
#include "MMMConverterS2KF/input.h"
#include "MMMConverterS2KF/person.h"
#include "common/convert/marker_mapping.h"
#include "common/convert/motion_converter.h"

namespace mmm_converter {

/// What the user asked for. Empty: a default.
struct ConversionRequest {
  InputRequest input;
  ConverterRequest converter;
  std::string output;         ///< input stem + "_mmm.xml", beside the input
  std::string output_format;  ///< "2.0" or "1.0"; empty: what the configuration says
  std::string csv_file;       ///< also write the trajectory with its standard deviations
  std::string motion_name;    ///< to write
  std::string model_path;     ///< to write, as it is
};

/// Everything that a summary tells.
struct ConversionReport {
  Input input;
  ConverterChoice converter;
  Person person;
  std::shared_ptr<const KinematicModel> model;  ///< scaled to the person
  std::string marker_set;                       ///< empty: the configuration has its own list
  MarkerMapping mapping;
  ConversionResult result;
  std::string output, output_format, motion_name;
  std::vector<std::string> warnings;
};

/// Reads the recording, loads and scales the model, matches the markers, converts, and writes the
/// motion. progress(done, all): frames.
/// @throws Error; the output is then as it was before.
ConversionReport RunConversion(const ConversionRequest& request,
                               const std::function<void(int, int)>& progress);

}  // namespace mmm_converter
