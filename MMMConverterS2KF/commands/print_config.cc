// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <iostream>

#include "MMMConverterS2KF/batch/manifest.h"
#include "MMMConverterS2KF/batch/manifest_attributes.h"
#include "MMMConverterS2KF/commands/commands.h"
#include "MMMConverterS2KF/terminal/command_line.h"
#include "common/convert/plugin_loader.h"

namespace mmm_converter {
namespace {

const std::vector<OptionGroup> kPrintConfigOptions = {
    {"Options",
     {{"plugin", "FILE", "the converter of this plugin file", ""},
      {"help,h", "", "print this help", ""}}}};

constexpr const char* kPrintConfigUsage = R"(MMMConverterS2KF print-config NAME
Prints the configuration of a converter: every setting with its default and a description. The name
"batch" prints an example of a manifest for the command batch, "batch-schema" the schema (XSD) of
manifests.

{}Examples
  MMMConverterS2KF print-config S2KFConverter > my.xml
  MMMConverterS2KF print-config batch > manifest.xml
  MMMConverterS2KF print-config batch-schema > batch.xsd
  MMMConverterS2KF print-config --plugin build/MyConverter.so
)";

}  // namespace

Manual PrintConfigManual() { return {kPrintConfigUsage, kPrintConfigOptions}; }

int RunPrintConfig(const Arguments& arguments) {
  if (const auto file = arguments.Get("plugin")) {
    std::cout << LoadedPlugin(*file).factory().config_template();
  } else if (arguments.positional() == "batch") {
    std::cout << ManifestTemplate();
  } else if (arguments.positional() == "batch-schema") {
    std::cout << ManifestSchema();
  } else if (arguments.positional()) {
    std::cout << LoadPluginByName(*arguments.positional()).factory().config_template();
  } else {
    throw UsageError(
        "print-config: which converter? For instance: MMMConverterS2KF print-config "
        "S2KFConverter");
  }
  return 0;
}

}  // namespace mmm_converter
