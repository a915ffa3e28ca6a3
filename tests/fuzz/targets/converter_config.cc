// SPDX-License-Identifier: MIT
#include "common/convert/converter_config.h"

#include "common/convert/settings.h"
#include "common/io/xml/xml_document.h"
#include "common/support/diagnostics.h"
#include "plugins/jacobian/jacobian_settings.h"
#include "plugins/s2kf/s2kf_settings.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/support/stick_model.h"

namespace mmm_converter::testing {
namespace {

/// A template of what was read is read as the same settings.
template <typename Settings>
void RequireSameTemplate(const ConverterConfig& config,
                         Settings (*read_settings)(const ConverterConfig&)) {
  Settings read = read_settings(config);
  const std::string text = FormatConfigTemplate(config.type, BindSettings(&read));
  Settings again = read_settings(ParseConverterConfig(text, kInputName));
  Require(FormatConfigTemplate(config.type, BindSettings(&again)) == text,
          "the same settings when they are written and read again");
}

}  // namespace

void ReadConverterConfigBytes(std::string_view bytes) {
  static const KinematicModel model = StickModel();
  Warnings warnings;
  const ConverterConfig config = ParseConverterConfig(std::string(bytes), kInputName, &warnings);
  if (config.type == "S2KFConverter") RequireSameTemplate(config, s2kf::ReadSettings);
  if (config.type == "JacobianConverter") RequireSameTemplate(config, jacobian::ReadSettings);
  ResolveJoints(config, model);
}

}  // namespace mmm_converter::testing
