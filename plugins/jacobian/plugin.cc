// SPDX-License-Identifier: MIT
#include <memory>
#include <string>

#include "common/convert/converter_config.h"
#include "common/convert/motion_converter.h"
#include "plugins/jacobian/jacobian_converter.h"
#include "plugins/jacobian/jacobian_settings.h"

namespace mmm_converter::jacobian {
namespace {

class JacobianConverterFactory : public MotionConverterFactory {
 public:
  std::string name() const override { return "JacobianConverter"; }
  std::string description() const override {
    return "framewise fit of the marker distances (least squares, Jacobian steps)";
  }
  std::string config_template() const override {
    JacobianSettings defaults;
    return FormatConfigTemplate(name(), BindSettings(&defaults));
  }
  std::unique_ptr<MotionConverter> Create(const TrackingSetup& setup,
                                          const ConverterConfig& config) const override {
    return std::make_unique<JacobianConverter>(setup, ReadSettings(config));
  }
};

}  // namespace
}  // namespace mmm_converter::jacobian

extern "C" {
mmm_converter::MotionConverterFactory* getFactory() {
  return new mmm_converter::jacobian::JacobianConverterFactory;
}
const char* getVersion() { return mmm_converter::kConverterInterfaceVersion; }
}
