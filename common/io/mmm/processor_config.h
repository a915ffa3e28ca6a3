// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

namespace mmm_converter {

/// What a stand-alone `<ModelProcessorConfig type="Winter">` file (KIT: config/<subject>.xml) says
/// of a person.
struct ProcessorConfig {
  std::optional<double> height;       ///< [m]
  std::optional<double> mass;         ///< [kg]
  std::optional<double> hand_length;  ///< [m]; cm in the file
};

/// @throws Error with file and line where it is not such a file or a number is malformed.
ProcessorConfig ReadProcessorConfig(const std::string& path);

/// As ReadProcessorConfig, from text; `file` is only named in messages.
ProcessorConfig ParseProcessorConfig(const std::string& xml, const std::string& file);

}  // namespace mmm_converter
