// SPDX-License-Identifier: MIT
#include "plugins/s2kf/belief.h"

#include "common/math/rotation.h"

namespace mmm_converter::s2kf {

void MoveRoot(const Eigen::Vector3d& dr, const Eigen::Vector3d& turn, RootParameters root,
              Belief* belief) {
  belief->position += dr;
  if (root == RootParameters::kRpy) {
    belief->rpy += turn;
    belief->orientation = Eigen::Quaterniond(RotationFromRpy(belief->rpy));
  } else {
    belief->orientation = (belief->orientation * Exp(turn)).normalized();
  }
}

void Move(const Eigen::Ref<const Eigen::VectorXd>& dx, RootParameters root, Belief* belief) {
  MoveRoot(dx.head<3>(), dx.segment<3>(3), root, belief);
  belief->parameters += dx.segment(6, belief->parameters.size());
}

void Difference(const Belief& a, const Belief& b, RootParameters root, Eigen::VectorXd* dx) {
  const Eigen::Index n = a.num_states();
  dx->resize(n + a.rate.size());
  dx->head<3>() = b.position - a.position;
  if (root == RootParameters::kRpy) {
    dx->segment<3>(3) = b.rpy - a.rpy;
  } else {
    dx->segment<3>(3) = Log(a.orientation.conjugate() * b.orientation);
  }
  dx->segment(6, a.parameters.size()) = b.parameters - a.parameters;
  dx->tail(a.rate.size()) = b.rate - a.rate;
}

void Mirror(int j, Belief* belief) {
  const int n = belief->num_states();
  for (int i = 6 + j; i < belief->P.rows(); i += n) {
    belief->P.row(i) *= -1;
    belief->P.col(i) *= -1;
  }
  if (belief->rate.size() > 0) belief->rate[6 + j] *= -1;
}

void Fold(const JointLimitTransform& transform, Belief* belief) {
  for (int j = 0; j < belief->parameters.size(); ++j) {
    if (transform.Fold(j, &belief->parameters[j])) Mirror(j, belief);
  }
}

}  // namespace mmm_converter::s2kf
