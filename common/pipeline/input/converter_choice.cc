// SPDX-License-Identifier: MIT
#include "common/pipeline/input/converter_choice.h"

#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/io/bytes/file_content.h"
#include "common/support/advice.h"
#include "common/support/data_directory.h"
#include "common/support/error.h"
#include "common/support/folder.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

namespace fs = std::filesystem;

constexpr const char* kDefaultConverter = "S2KFConverter";
constexpr const char* kDefaultConfig = "s2kf_default";

std::string ShippedConfig(const std::string& name) {
  return DataDirectory() + "/converters/" + name + ".xml";
}

std::vector<std::string> ShippedConfigs() {
  return StemsIn(DataDirectory() + "/converters", ".xml");
}

// A file, or the shipped configuration of that name.
std::string FindConfig(const std::string& config) {
  std::error_code failure;
  if (fs::exists(config, failure)) return config;
  std::string shipped = ShippedConfig(config);
  if (fs::exists(shipped, failure)) return shipped;
  throw Error(fmt::format("{}: no such file, nor a shipped configuration; these are {}", config,
                          JoinNames(ShippedConfigs(), ", ")));
}

// The configuration given, or else the shipped one of the default converter.
std::optional<std::string> ConfigFile(const ConverterRequest& request,
                                      const std::string& converter) {
  if (!request.config.empty()) return FindConfig(request.config);
  if (converter.empty() || converter == kDefaultConverter) return ShippedConfig(kDefaultConfig);
  return std::nullopt;
}

void ReadConfig(const ConverterRequest& request, const std::string& converter,
                ConverterChoice* choice, Warnings* warnings) {
  ConverterConfig& config = choice->config;
  if (const auto file = ConfigFile(request, converter)) {
    config = ReadConverterConfig(*file, warnings);
    choice->text = ReadFileContent(*file);
  } else {
    config.file = "defaults of " + converter;
  }
  if (config.type.empty()) config.type = converter.empty() ? kDefaultConverter : converter;
  if (!converter.empty() && config.type != converter) {
    throw Error(fmt::format(
        "{}: is a configuration for {}, not for {}; use {} {}, or print "
        "a configuration with print-config {}",
        config.file, config.type, converter, OptionText("converter"), config.type, converter));
  }
}

}  // namespace

ConverterChoice ChooseConverter(const ConverterRequest& request, Warnings* warnings) {
  ConverterChoice choice;
  std::string converter = request.converter;
  if (!request.plugin_file.empty()) {
    choice.plugin = std::make_shared<LoadedPlugin>(request.plugin_file);
    const std::string name = choice.plugin->factory().name();
    if (!converter.empty() && converter != name) {
      throw Error(
          fmt::format("{}: has the converter {}, not {}", request.plugin_file, name, converter));
    }
    converter = name;
  }
  ReadConfig(request, converter, &choice, warnings);
  if (!choice.plugin) {
    choice.plugin = std::make_shared<LoadedPlugin>(LoadPluginByName(choice.config.type, warnings));
  }
  if (choice.text.empty()) choice.text = choice.plugin->factory().config_template();
  return choice;
}

void NameInputs(const ConverterChoice& choice, OutputPlan* plan) {
  const ConverterConfig& config = choice.config;
  plan->Read(config.file);
  plan->Read(config.subject_file);
  plan->Read((fs::path(config.file).parent_path() / config.marker_set).string());
  if (choice.plugin) plan->Read(choice.plugin->path());
}

WithWarnings<std::shared_ptr<const ConverterChoice>> ChooseOnce(const ConverterRequest& request) {
  WithWarnings<std::shared_ptr<const ConverterChoice>> choice;
  choice.value =
      std::make_shared<const ConverterChoice>(ChooseConverter(request, &choice.warnings));
  return choice;
}

}  // namespace mmm_converter
