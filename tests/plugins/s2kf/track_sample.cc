// SPDX-License-Identifier: MIT
// track_sample s2kf-regression|s2kf-exact|ekf|fit: tracks the start of the handstand, with gaps,
// and writes where the model's markers are in each frame, all digits. For instruction_set_test.
#include <cstdio>
#include <string>

#include "common/fit/posture_fit.h"
#include "common/motion/marker_synthesis.h"
#include "plugins/s2kf/s2kf_converter.h"
#include "tests/plugins/s2kf/tracking_run.h"
#include "tests/support/acrobatics.h"
#include "tests/support/changed_markers.h"

namespace mmm_converter::s2kf {
namespace {

constexpr int kFrames = 200;

void Print(const Eigen::Matrix3Xd& markers) {
  for (const double value : markers.reshaped()) std::printf("%.17g\n", value);
}

int Run(const std::string& method) {
  const KinematicModel model = ScaledReferenceModel(1.8);
  const MarkerSequence all =
      SynthesizeMarkers(model, testing::MakeKickedHandstand(model), MarkerErrors{}, 1);
  const MarkerSequence markers = testing::OccludeShare(all.Slice(0, kFrames), 0.2, 30, 1);
  const std::vector<MarkerAssignment> assignments = AssignAll(model, markers);
  const std::vector<int> joints = MotionJoints(model, 44);
  S2kfSettings settings;
  if (method == "s2kf-exact") settings.update = UpdateForm::kExact;
  if (method == "ekf") settings.filter = FilterType::kEkf;
  S2kfConverter converter(SetupOf(model, joints, assignments), settings);
  const MarkerKinematics kinematics(model, joints, MarkerIndices(assignments));
  MarkerJacobian at = kinematics.MakeJacobian();
  PostureFit fit(kinematics);
  const Eigen::VectorXd scale = Eigen::VectorXd::Ones(kinematics.num_markers());
  // As shipped (jacobian_least_squares). A fit that is driven to the last digits ends by decisions
  // at rounding level, and is then as exact as its weakest direction only.
  PostureFitOptions options;
  options.tolerance = 1e-6;
  Posture posture;
  for (int k = 0; k < kFrames; ++k) {
    const FrameEstimate& estimate =
        k == 0 ? converter.Assemble(markers.frame(0)) : converter.Track(markers.frame(k), 0.01);
    if (k == 0 || method != "fit") {
      posture = estimate.posture;
      posture.joint_angles = Eigen::VectorXd(estimate.posture.joint_angles(joints));
    }
    if (method == "fit") fit.Solve(markers.frame(k), scale, options, &posture);
    kinematics.ComputeMarkers(posture.position, posture.orientation.toRotationMatrix(),
                              posture.joint_angles, &at);
    Print(at.p_WM);
  }
  return 0;
}

}  // namespace
}  // namespace mmm_converter::s2kf

int main(int argc, char** argv) { return argc == 2 ? mmm_converter::s2kf::Run(argv[1]) : 2; }
