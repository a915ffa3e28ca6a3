// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "common/model/body_size.h"

namespace mmm_converter {

/// What a stand-alone `<ModelProcessorConfig type="Winter">` file (KIT: `config/<subject>.xml`)
/// says of a person.
/// @throws Error with file and line where it is not such a file or a number is malformed.
BodySize ReadProcessorConfig(const std::string& path);

/// As ReadProcessorConfig, from text; `file` is only named in messages.
BodySize ParseProcessorConfig(const std::string& xml, const std::string& file);

}  // namespace mmm_converter
