// SPDX-License-Identifier: MIT
#include "plugins/s2kf/belief.h"

#include "common/math/rotation.h"

namespace mmm_converter::s2kf {

void Move(const Eigen::Ref<const Eigen::VectorXd>& dx, RootParameters root, Belief* belief) {
  belief->position += dx.head<3>();
  if (root == RootParameters::kRpy) {
    belief->rpy += dx.segment<3>(3);
    belief->orientation = Eigen::Quaterniond(RotationFromRpy(belief->rpy));
  } else {
    belief->orientation = (belief->orientation * Exp(dx.segment<3>(3))).normalized();
  }
  belief->parameters += dx.segment(6, belief->parameters.size());
}

}  // namespace mmm_converter::s2kf
