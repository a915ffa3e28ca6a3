// SPDX-License-Identifier: MIT
#include "tests/cli/moving_object.h"

#include <fmt/format.h>

#include <cmath>

#include "common/math/rotation.h"

namespace mmm_converter::testing {

Eigen::Isometry3d MovingPose(int frame, double phase) {
  const double t = 0.03 * frame + phase;
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.linear() =
      Exp(Eigen::Vector3d(std::sin(t), 0.5 * std::sin(1.3 * t), 0.7 * t)).toRotationMatrix();
  X.translation() = Eigen::Vector3d(0.4 + 0.2 * std::sin(t) + phase, -0.3 * t,  //
                                    1 + 0.1 * std::sin(2 * t));
  return X;
}

std::string SlidingBox(const std::string& model_path, int frames) {
  std::string text = fmt::format(
      R"(<MMM version="2.0"><Motion name="box" type="object"><Model path="{}"/>
<Sensors><Sensor type="ModelPose" version="1.0"><Configuration/><Data>)",
      model_path);
  for (int k = 0; k < frames; ++k) {
    text += fmt::format(
        R"(<Measurement timestep="{}"><RootPosition>{} 0 900</RootPosition>
<RootRotation>0 0 0</RootRotation></Measurement>)",
        0.01 * k, k);
  }
  return text + "</Data></Sensor></Sensors></Motion></MMM>";
}

}  // namespace mmm_converter::testing
