// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace mmm_converter::testing {

/// Path of a plugin of tests/support/test_plugin: "test_converter", "faulty_converter",
/// "old_version", "no_factory", "null_factory" or, on x86-64, "other_alignment".
inline std::string TestPlugin(const std::string& name) {
  return std::string(MMM_CONVERTER_BINARY_DIR "/tests/plugins/") + name + "/" + name + ".so";
}

}  // namespace mmm_converter::testing
