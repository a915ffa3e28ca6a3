// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace mmm_converter {

struct ColladaFacts {
  bool is_y_up = true;
};

/// What assimp does not look at: that parts which are used again and again stay few, and none is in
/// itself.
/// @throws Error with the file, and as ParseXml.
ColladaFacts CheckCollada(std::string_view content, const std::string& file);

}  // namespace mmm_converter
