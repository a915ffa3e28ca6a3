// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include "common/convert/converter_config.h"
#include "common/convert/plugin_loader.h"
#include "common/support/output_plan.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// Which converter and which configuration are meant. Empty: a default.
struct ConverterRequest {
  std::string config;  ///< file, or the name of a shipped one: "s2kf_paper"
  std::string converter;
  std::string plugin_file;
};

struct ConverterChoice {
  ConverterConfig config;  ///< type is the converter's name
  std::string text;        ///< of the configuration
  std::shared_ptr<const LoadedPlugin> plugin;
};

/// @throws Error where there is no such file or plugin, or they do not belong together.
ConverterChoice ChooseConverter(const ConverterRequest& request, Warnings* warnings);

/// The choice for several conversions. @throws Error as ChooseConverter.
WithWarnings<std::shared_ptr<const ConverterChoice>> ChooseOnce(const ConverterRequest& request);

/// Says in the plan which files the choice is from, and which its configuration names.
void NameInputs(const ConverterChoice& choice, OutputPlan* plan);

}  // namespace mmm_converter
