// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "common/convert/marker_mapping.h"
#include "common/io/xml_document.h"

namespace mmm_converter {

/// A `<ConverterConfig type="...">` file: what every converter shares, and the rest for the plugin.
struct ConverterConfig {
  std::string file;             ///< for messages
  std::string type;             ///< converter name, e.g. "S2KFConverter"
  std::string model_processor;  ///< Model@name, "Winter"
  std::vector<MarkerPair> marker_pairs;
  std::vector<std::string>
      joints;  ///< joints to track, in output order; empty: the plugin's default
  std::vector<XmlElement> plugin_elements;  ///< all that common code does not know
};

/// @throws Error with file and line for anything that is not well-formed or not allowed.
ConverterConfig ReadConverterConfig(const std::string& path);

}  // namespace mmm_converter
