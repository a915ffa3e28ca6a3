// SPDX-License-Identifier: MIT
#include "plugins/s2kf/tracked_frame.h"

#include <algorithm>
#include <cmath>

#include "common/support/units.h"

namespace mmm_converter::s2kf {

using Eigen::Index;
using Eigen::Matrix3Xd;

TrackedFrame::TrackedFrame(const MarkerKinematics& kinematics)
    : measured(Matrix3Xd::Constant(3, kinematics.num_markers(), kNaN)),
      relabelled(measured),
      z(measured),
      outcome(kinematics.num_dofs(), kinematics.num_markers()),
      at(kinematics.MakeJacobian()) {
  posture.joint_angles.setZero(kinematics.num_joints());
}

int CountSeen(const Matrix3Xd& z) {
  int seen = 0;
  for (Index m = 0; m < z.cols(); ++m) seen += z.col(m).allFinite();
  return seen;
}

double ClippedMeanDistance(const Matrix3Xd& a, const Matrix3Xd& b, double limit) {
  double sum = 0;
  int seen = 0;
  for (Index i = 0; i < a.cols(); ++i) {
    const double distance = (a.col(i) - b.col(i)).norm();
    if (!std::isfinite(distance)) continue;
    sum += std::min(distance, limit);
    ++seen;
  }
  return sum / std::max(seen, 1);
}

}  // namespace mmm_converter::s2kf
