// SPDX-License-Identifier: MIT
// A converter that does what a host must survive: MMM_CONVERTER_TEST_FAULT says what.
#include <Eigen/Core>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include "common/convert/converter_config.h"
#include "common/convert/motion_converter.h"
#include "common/model/posture.h"

namespace mmm_converter {
namespace {

bool IsFault(const std::string& fault) {
  const char* wanted = std::getenv("MMM_CONVERTER_TEST_FAULT");
  return wanted != nullptr && fault == wanted;
}

// The stack, to its end.
int Fill(int calls) {
  volatile char some[1024] = {};
  some[0] = static_cast<char>(calls);
  return calls == 0 ? 0 : Fill(calls - 1) + some[0];
}

// What exit() destroys before what the host had asked it to do.
struct NotToBeDestroyed {
  ~NotToBeDestroyed() { std::abort(); }
};

[[noreturn]] void Exit() {
  static const NotToBeDestroyed late;
  std::exit(0);
}

class FaultyConverter final : public MotionConverter {
 public:
  explicit FaultyConverter(TrackingSetup setup) : MotionConverter(std::move(setup)) {}

  const FrameEstimate& Assemble(const Eigen::Ref<const Eigen::Matrix3Xd>& frame) override {
    return Track(frame, 0);
  }

  const FrameEstimate& Track(const Eigen::Ref<const Eigen::Matrix3Xd>&, double /*dt*/) override {
    const int assignments = static_cast<int>(setup().assignments().size());
    const int joints = setup().model->num_joints();
    estimate_.posture = ZeroPosture(*setup().model);
    estimate_.residuals.setZero(assignments);
    estimate_.verdicts.setConstant(assignments, kAsLabelled);
    if (IsFault("stack")) Fill(1000000000);
    if (IsFault("abort")) std::abort();
    if (IsFault("exit")) Exit();
    if (IsFault("int")) throw 42;
    if (IsFault("exception")) throw std::runtime_error("an iterator went astray");
    if (IsFault("angles")) estimate_.posture.joint_angles.setZero(joints + 1);
    if (IsFault("NaN")) estimate_.posture.position.x() = std::numeric_limits<double>::quiet_NaN();
    if (IsFault("orientation")) estimate_.posture.orientation.coeffs().setZero();
    if (IsFault("residuals")) estimate_.residuals.setZero(assignments + 1);
    if (IsFault("infinite residual")) estimate_.residuals[0] = HUGE_VAL;
    if (IsFault("deviations")) estimate_.standard_deviations.setZero(joints);
    if (IsFault("verdicts")) estimate_.verdicts.setZero(1);
    if (IsFault("verdict")) estimate_.verdicts[0] = 1000000;
    if (IsFault("count")) estimate_.markers_seen = -1;
    return estimate_;
  }

  ConversionResult Convert(const MarkerSequence& recording,
                           const std::function<bool(int)>& progress) override {
    ConversionResult result = MotionConverter::Convert(recording, progress);
    PoseTrajectory& trajectory = result.trajectory;
    if (IsFault("postures")) trajectory.postures.pop_back();
    if (IsFault("joint names")) trajectory.joint_names[0] = "tail";
    if (IsFault("result angles")) trajectory.postures[0].joint_angles.resize(0);
    if (IsFault("rate")) trajectory.rate = 0;
    if (IsFault("velocities")) trajectory.velocities.setZero(1, 1);
    if (IsFault("result residuals")) result.residuals.resize(1, 1);
    if (IsFault("frames")) result.frames.clear();
    if (IsFault("incident")) result.incidents.push_back({{}, 1000000, -1, 0, 0});
    if (IsFault("kind")) result.incidents.push_back({MarkerIncident::Kind(7), 0, -1, 0, 0});
    if (IsFault("noise")) result.process_noise_scale = 0;
    return result;
  }

 private:
  FrameEstimate estimate_;
};

class FaultyFactory final : public MotionConverterFactory {
 public:
  std::string name() const override {
    if (IsFault("name")) throw std::runtime_error("it has forgotten its name");
    return "FaultyConverter";
  }
  std::string description() const override { return "does what a host must survive"; }
  std::string config_template() const override {
    return FormatConfigTemplate("FaultyConverter", SettingTable());
  }
  std::unique_ptr<MotionConverter> Create(const TrackingSetup& setup,
                                          const ConverterConfig&) const override {
    if (IsFault("null")) return nullptr;
    if (IsFault("creation")) std::abort();
    TrackingSetup own = setup;
    if (IsFault("joint")) own.joints[0] = 1000000;
    if (IsFault("marker")) own.mapping.assignments[0].marker = MarkerIx(1000000);
    if (IsFault("model")) own.model = nullptr;
    return std::make_unique<FaultyConverter>(std::move(own));
  }
};

}  // namespace
}  // namespace mmm_converter

extern "C" {
mmm_converter::MotionConverterFactory* getFactory() {
  if (mmm_converter::IsFault("factory")) throw 42;
  return new mmm_converter::FaultyFactory;
}
const char* getVersion() { return mmm_converter::kConverterInterfaceVersion; }
}
