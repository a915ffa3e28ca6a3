// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/convert/converter_config.h"
#include "common/convert/marker_mapping.h"
#include "common/convert/motion_converter.h"
#include "common/io/recording.h"

namespace mmm_converter {

/// What the user asked for. Empty: a default.
struct ConversionRequest {
  std::string input;
  std::string output;         ///< input stem + "_mmm.xml", beside the input
  std::string output_format;  ///< "2.0" or "1.0"; empty: what the configuration says
  std::string csv_file;       ///< also write the trajectory with its standard deviations
  ReadRecordingOptions recording;
  std::string motion_name;         ///< to write
  std::optional<int> first_frame;  ///< counted from 0
  std::optional<int> end_frame;    ///< the frame behind the last
  std::string model_file;
  std::string model_path;      ///< to write, as it is
  std::string processor_file;  ///< ModelProcessorConfig of the person
  std::optional<double> height, mass, hand_length;
  std::string config_file;
  std::string converter;
  std::string plugin_file;
};

/// A number of the person, and where it is from.
struct PersonValue {
  double value = 0;
  std::string source;  ///< "given", a file, "assumed", "estimated from the recording"
};

/// Everything that a summary tells.
struct ConversionReport {
  Recording recording;  ///< the frames that were converted
  int first_frame = 0;  ///< of them, counted from 0
  std::string model_file, model_name;
  PersonValue height, mass;
  std::optional<double> hand_length;
  ConverterConfig config;
  std::string converter, plugin_file;
  std::vector<std::string> model_markers;  ///< names, by index
  std::string marker_set;                  ///< empty: the configuration has its own list
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
