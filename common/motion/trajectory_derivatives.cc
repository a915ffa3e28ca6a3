// SPDX-License-Identifier: MIT
#include "common/motion/trajectory_derivatives.h"

#include <algorithm>

#include "common/math/rotation.h"

namespace mmm_converter {

void Differentiate(PoseTrajectory* trajectory) {
  const int frames = trajectory->num_frames();
  const auto size = static_cast<Eigen::Index>(6 + trajectory->joint_names.size());
  trajectory->velocities.setZero(size, frames);
  trajectory->accelerations.setZero(size, frames);
  if (frames < 2) return;
  const double rate = trajectory->rate;
  // Between frames k and k + 1.
  Eigen::MatrixXd between(size, frames - 1);
  for (int k = 0; k + 1 < frames; ++k) {
    const Posture& q0 = trajectory->postures[k];
    const Posture& q1 = trajectory->postures[k + 1];
    between.col(k) << q1.position - q0.position, Log(q1.orientation * q0.orientation.conjugate()),
        q1.joint_angles - q0.joint_angles;
  }
  between *= rate;
  if (frames == 2) {
    trajectory->velocities.colwise() = between.col(0);
    return;
  }
  for (int k = 0; k < frames; ++k) {
    const int inner = std::clamp(k, 1, frames - 2);
    const Eigen::VectorXd acceleration = rate * (between.col(inner) - between.col(inner - 1));
    trajectory->velocities.col(k) =
        0.5 * (between.col(inner) + between.col(inner - 1)) + (k - inner) / rate * acceleration;
    trajectory->accelerations.col(k) = acceleration;
  }
}

}  // namespace mmm_converter
