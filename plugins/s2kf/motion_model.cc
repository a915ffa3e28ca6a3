// SPDX-License-Identifier: MIT
#include "plugins/s2kf/motion_model.h"

#include <Eigen/LU>
#include <cmath>

namespace mmm_converter::s2kf {

using Eigen::Matrix2d;
using Eigen::Vector2d;

namespace {

/// x stays, or drifts back so that its stationary variance is `spread`^2.
void SetWalk(double noise, double spread, double dt, Matrix2d* F, Matrix2d* Q) {
  F->setZero();
  Q->setZero();
  // The stationary variance of x' = -x / tau + w is noise^2 tau / 2.
  (*F)(0, 0) = spread > 0 ? std::exp(-dt * noise * noise / (2 * spread * spread)) : 1;
  (*Q)(0, 0) = noise * noise * dt;
}

/// Q of an acceleration w ~ N(0, noise^2 / dt), constant for dt, that moves [x; v] by g w.
Matrix2d NoiseOfAcceleration(double noise, double dt, const Vector2d& g) {
  return noise * noise / dt * g * g.transpose();
}

/// x' = v, v' = -v / decay + w.
void SetDampedRate(double noise, double decay, double dt, Matrix2d* F, Matrix2d* Q) {
  const double a = std::exp(-dt / decay);
  const double advance = decay * (1 - a);
  *F << 1, advance, 0, a;
  *Q = NoiseOfAcceleration(noise, dt, {decay * (dt - advance), advance});
}

/// x'' = -2 omega x' - omega^2 x + w, whose stationary variance noise^2 / (4 omega^3) is spread^2.
void SetSpring(double noise, double spread, double dt, Matrix2d* F, Matrix2d* Q) {
  const double omega = std::cbrt(noise * noise / (4 * spread * spread));
  const double a = std::exp(-omega * dt);
  *F << a * (1 + omega * dt), a * dt, -a * omega * omega * dt, a * (1 - omega * dt);
  *Q = NoiseOfAcceleration(noise, dt, {(1 - a * (1 + omega * dt)) / (omega * omega), a * dt});
}

}  // namespace

ProcessNoise ProcessNoise::Scaled(double scale) const {
  const double factor = std::sqrt(scale);
  return {factor * position, factor * orientation, factor * parameters};
}

const Matrix2d& CoordinateMaps::Of(int i) const {
  if (i < 3) return position;
  return i < 6 ? orientation : parameters;
}

CoordinateMaps CoordinateMaps::Inverse(bool velocity) const {
  const auto invert = [&](const Matrix2d& M) {
    Matrix2d inverse = Matrix2d::Zero();
    if (velocity) {
      inverse = M.inverse();
    } else {
      inverse(0, 0) = 1 / M(0, 0);
    }
    return inverse;
  };
  return {invert(position), invert(orientation), invert(parameters)};
}

void CoordinateMaps::Apply(int n, Eigen::VectorXd* dx) const {
  const bool velocity = dx->size() > n;
  for (int i = 0; i < n; ++i) {
    const Matrix2d& M = Of(i);
    const double x = (*dx)[i];
    if (!velocity) {
      (*dx)[i] = M(0, 0) * x;
      continue;
    }
    const double v = (*dx)[n + i];
    (*dx)[i] = M(0, 0) * x + M(0, 1) * v;
    (*dx)[n + i] = M(1, 0) * x + M(1, 1) * v;
  }
}

void CoordinateMaps::Apply(int n, Eigen::MatrixXd* P) const {
  const Eigen::Index all = P->rows();
  const bool velocity = all > n;
  for (int j = 0; j < n; ++j) {
    const Matrix2d& M = Of(j);
    double* x = P->col(j).data();
    double* v = velocity ? P->col(n + j).data() : x;
    for (Eigen::Index i = 0; i < all; ++i) {
      const double x_i = x[i];
      const double v_i = v[i];
      if (velocity) v[i] = M(1, 0) * x_i + M(1, 1) * v_i;
      x[i] = M(0, 0) * x_i + (velocity ? M(0, 1) * v_i : 0);
    }
  }
  for (Eigen::Index j = 0; j < all; ++j) {
    double* x = P->col(j).data();
    for (int i = 0; i < n; ++i) {
      const Matrix2d& M = Of(i);
      const double x_i = x[i];
      x[i] = M(0, 0) * x_i;
      if (!velocity) continue;
      x[i] += M(0, 1) * x[n + i];
      x[n + i] = M(1, 0) * x_i + M(1, 1) * x[n + i];
    }
  }
}

MotionModel::Step MotionModel::StepOf(double dt) const {
  Step step;
  CoordinateMaps& F = step.F;
  CoordinateMaps& Q = step.Q;
  const bool springs = natural_spread > 0 && noise.parameters > 0;
  if (!velocity) {
    SetWalk(noise.position, 0, dt, &F.position, &Q.position);
    SetWalk(noise.orientation, 0, dt, &F.orientation, &Q.orientation);
    SetWalk(noise.parameters, springs ? natural_spread : 0, dt, &F.parameters, &Q.parameters);
    return step;
  }
  SetDampedRate(noise.position, velocity_decay, dt, &F.position, &Q.position);
  SetDampedRate(noise.orientation, velocity_decay, dt, &F.orientation, &Q.orientation);
  if (springs) {
    SetSpring(noise.parameters, natural_spread, dt, &F.parameters, &Q.parameters);
  } else {
    SetDampedRate(noise.parameters, velocity_decay, dt, &F.parameters, &Q.parameters);
  }
  return step;
}

void MotionModel::Predict(double dt, RootParameters root, Belief* belief) const {
  const int n = belief->num_states();
  const Step step = StepOf(dt);
  if (velocity) {
    MoveRoot(step.F.position(0, 1) * belief->rate.head<3>(),
             step.F.orientation(0, 1) * belief->rate.segment<3>(3), root, belief);
    belief->rate.head<3>() *= step.F.position(1, 1);
    belief->rate.segment<3>(3) *= step.F.orientation(1, 1);
  }
  const Matrix2d& F = step.F.parameters;
  for (Eigen::Index j = 0; j < belief->parameters.size(); ++j) {
    double reference = natural.size() > 0 ? natural[j] : 0;
    if (std::isnan(reference)) reference = belief->parameters[j];
    const double x = belief->parameters[j] - reference;
    belief->parameters[j] = reference + F(0, 0) * x;
    if (!velocity) continue;
    double& rate = belief->rate[6 + j];
    belief->parameters[j] += F(0, 1) * rate;
    rate = F(1, 0) * x + F(1, 1) * rate;
  }
  step.F.Apply(n, &belief->P);
  for (int i = 0; i < n; ++i) {
    const Matrix2d& Q = step.Q.Of(i);
    belief->P(i, i) += Q(0, 0);
    if (!velocity) continue;
    belief->P(i, n + i) += Q(0, 1);
    belief->P(n + i, i) += Q(1, 0);
    belief->P(n + i, n + i) += Q(1, 1);
  }
}

}  // namespace mmm_converter::s2kf
