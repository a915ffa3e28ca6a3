// SPDX-License-Identifier: MIT
#include <memory>
#include <string>

#include "common/convert/converter_config.h"
#include "common/convert/motion_converter.h"
#include "common/support/diagnostics.h"
#include "plugins/s2kf/s2kf_converter.h"
#include "plugins/s2kf/s2kf_settings.h"

namespace mmm_converter::s2kf {
namespace {

class S2kfConverterFactory : public MotionConverterFactory {
 public:
  std::string name() const override { return "S2KFConverter"; }
  std::string description() const override {
    return "whole-body tracking with the Smart Sampling Kalman Filter (S2KF, UKF, EKF)";
  }
  std::string config_template() const override {
    S2kfSettings defaults;
    return FormatConfigTemplate(name(), BindSettings(&defaults));
  }
  std::unique_ptr<MotionConverter> Create(const TrackingSetup& setup,
                                          const ConverterConfig& config) const override {
    return std::make_unique<S2kfConverter>(setup, ReadSettings(config));
  }
};

}  // namespace
}  // namespace mmm_converter::s2kf

extern "C" {
mmm_converter::MotionConverterFactory* getFactory() {
  return new mmm_converter::s2kf::S2kfConverterFactory;
}
const char* getVersion() { return mmm_converter::kConverterInterfaceVersion; }
}
