// SPDX-License-Identifier: MIT
#include "plugins/s2kf/motion_model.h"

#include <cmath>

namespace mmm_converter::s2kf {

namespace {

template <typename Diagonal>
void AddNoise(const ProcessNoise& noise, double dt, Diagonal&& diagonal) {
  diagonal.template head<3>().array() += noise.position * noise.position * dt;
  diagonal.template segment<3>(3).array() += noise.orientation * noise.orientation * dt;
  diagonal.tail(diagonal.size() - 6).array() += noise.parameters * noise.parameters * dt;
}

}  // namespace

void MotionModel::Predict(double dt, RootParameters root, Belief* belief) const {
  const int n = belief->num_states();
  Eigen::MatrixXd& P = belief->P;
  if (velocity) {
    // x += T v, v *= a; the same map, row by row and column by column, takes P to F P F^T.
    const double a = std::exp(-dt / velocity_decay);
    const double T = velocity_decay * (1 - a);
    Move(T * belief->rate, root, belief);
    belief->rate *= a;
    P.topRows(n) += T * P.bottomRows(n);
    P.bottomRows(n) *= a;
    P.leftCols(n) += T * P.rightCols(n);
    P.rightCols(n) *= a;
    AddNoise(velocity_noise, dt, P.diagonal().tail(n));
  }
  if (natural_spread > 0) {
    // The stationary variance of theta' = -theta / tau + w is noise^2 tau / 2.
    const double tau = 2 * natural_spread * natural_spread / (noise.parameters * noise.parameters);
    const double a = std::exp(-dt / tau);
    belief->parameters = natural + a * (belief->parameters - natural);
    const auto joints = belief->parameters.size();
    P.middleRows(6, joints) *= a;
    P.middleCols(6, joints) *= a;
  }
  AddNoise(noise, dt, P.diagonal().head(n));
}

}  // namespace mmm_converter::s2kf
