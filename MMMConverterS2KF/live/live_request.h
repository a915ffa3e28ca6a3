// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "common/pipeline/exporters.h"
#include "common/pipeline/input/converter_choice.h"
#include "common/pipeline/input/input.h"

namespace mmm_converter {

/// What the user asked for. Empty: a default.
struct LiveRequest {
  InputRequest input;  ///< file: the source's address; person, model and markers as of a conversion
  ConverterRequest converter;
  bool loops = false;  ///< of a replay
  bool label = false;  ///< points are named by the body, whatever the source calls them
  double calibration_time =
      0;  ///< seconds of moving about that the person is estimated from; 0: none
  std::string subject_output;             ///< also write the estimated subject
  std::string output;                     ///< the motion; empty: none is written
  std::string output_format;              ///< "2.0" or "1.0"; empty: what the configuration says
  std::string motion_name;                ///< to write
  std::string model_path;                 ///< to write, as it is
  ExportFiles exports;                    ///< written at the end, for other programs
  std::vector<std::string> more_outputs;  ///< that the caller writes
  std::vector<std::string> sinks;         ///< addresses that postures are sent to
  bool view = false;                      ///< serve the page
  std::string view_address;               ///< "HOST:PORT" to listen on; empty: loopback, any port
  double longest = 0;                     ///< ends after so many seconds; 0: never
  bool realtime = false;                  ///< ask the system for real-time priority
  int processor = -1;                     ///< that the tracking thread stays on; -1: any
};

}  // namespace mmm_converter
