// SPDX-License-Identifier: MIT
// A converter for tests of everything around converters: the model stands unrotated, its joints at
// their natural zero, its root on the mean of the seen markers. Compile definitions make it faulty.
#include <Eigen/Core>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "common/convert/converter_config.h"
#include "common/convert/motion_converter.h"
#include "common/model/forward_kinematics.h"
#include "common/model/posture.h"
#include "common/support/error.h"

namespace mmm_converter {
namespace {

struct TestSettings {
  double height_offset = 0;  // [m]
  int fewest_markers = 3;
};

SettingTable MakeTable(TestSettings* settings) {
  SettingTable table;
  table.AddElement("Test", "Where the model is put.");
  table.Add("Test", "heightOffset_mm", &settings->height_offset, 1e-3, -1000, 1000,
            "raises the root above the mean of the markers");
  table.Add("Test", "fewestMarkers", &settings->fewest_markers, 3, 100,
            "frames with fewer are not converged");
  return table;
}

class TestConverter final : public MotionConverter {
 public:
  TestConverter(const TrackingSetup& setup, const TestSettings& settings)
      : MotionConverter(setup), settings_(settings) {
    estimate_.posture = ZeroPosture(*setup.model);
    estimate_.standard_deviations.setZero(6 + setup.model->num_joints());
    estimate_.residuals.setZero(static_cast<int>(setup.assignments().size()));
  }

  const FrameEstimate& Assemble(const Eigen::Ref<const Eigen::Matrix3Xd>& frame) override {
    return Track(frame, 0);
  }

  const FrameEstimate& Track(const Eigen::Ref<const Eigen::Matrix3Xd>& frame,
                             double /*dt*/) override {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    estimate_.markers_seen = 0;
    const std::vector<MarkerAssignment>& assignments = setup().assignments();
    for (const MarkerAssignment& assignment : assignments) {
      if (!IsSeen(frame.col(assignment.label))) continue;
      sum += frame.col(assignment.label);
      ++estimate_.markers_seen;
    }
    estimate_.converged = estimate_.markers_seen >= settings_.fewest_markers;
    if (estimate_.markers_seen > 0) {
      estimate_.posture.position =
          sum / estimate_.markers_seen + settings_.height_offset * Eigen::Vector3d::UnitZ();
    }
    const Eigen::Matrix3Xd p_WM = MarkerPositions(*setup().model, estimate_.posture);
    for (std::size_t i = 0; i < assignments.size(); ++i) {
      estimate_.residuals[static_cast<int>(i)] =
          (frame.col(assignments[i].label) - p_WM.col(assignments[i].marker)).norm();
    }
    return estimate_;
  }

 private:
  TestSettings settings_;
  FrameEstimate estimate_;
};

class TestFactory final : public MotionConverterFactory {
 public:
  std::string name() const override { return "TestConverter"; }
  std::string description() const override { return "puts a rigid model on the mean marker"; }
  std::string config_template() const override {
    TestSettings settings;
    return FormatConfigTemplate(name(), MakeTable(&settings));
  }
  std::unique_ptr<MotionConverter> Create(const TrackingSetup& setup,
                                          const ConverterConfig& config) const override {
    TestSettings settings;
    Diagnostics diagnostics(config.file);
    MakeTable(&settings).Read(config.plugin_elements, &diagnostics);
    diagnostics.ThrowIfErrors();
    return std::make_unique<TestConverter>(setup, settings);
  }
};

}  // namespace
}  // namespace mmm_converter

extern "C" {

#if !defined(TEST_PLUGIN_NO_FACTORY)
mmm_converter::MotionConverterFactory* getFactory() {
#if defined(TEST_PLUGIN_NULL_FACTORY)
  return nullptr;
#else
  return new mmm_converter::TestFactory;
#endif
}
#endif

const char* getVersion() {
#if defined(TEST_PLUGIN_OLD_VERSION)
  return "MMMConverterS2KF-0";
#else
  return mmm_converter::kConverterInterfaceVersion;
#endif
}
}
