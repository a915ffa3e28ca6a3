// SPDX-License-Identifier: MIT
#include "common/forces/plate_forces.h"

#include <utility>

namespace mmm_converter {
namespace {

using Rows = Eigen::Matrix3Xd;

/// Forces and moments in P, before ORIGIN is accounted for.
struct Measured {
  Rows force, moment;
};

Measured FromForcesAndCop(const ForcePlate& plate, const Eigen::MatrixXd& v) {
  const Eigen::RowVectorXd x = plate.file_unit * v.row(3);
  const Eigen::RowVectorXd y = plate.file_unit * v.row(4);
  Measured measured{plate.force_unit * v.topRows(3), Rows(3, v.cols())};
  const Rows& f = measured.force;
  measured.moment.row(0) = y.cwiseProduct(f.row(2));
  measured.moment.row(1) = -x.cwiseProduct(f.row(2));
  measured.moment.row(2) =
      x.cwiseProduct(f.row(1)) - y.cwiseProduct(f.row(0)) + plate.moment_unit * v.row(5);
  return measured;
}

Measured FromEightForces(const ForcePlate& plate, const Eigen::MatrixXd& v) {
  const double a = plate.origin.x();
  const double b = plate.origin.y();
  Measured measured{Rows(3, v.cols()), Rows(3, v.cols())};
  measured.force.row(0) = v.row(0) + v.row(1);
  measured.force.row(1) = v.row(2) + v.row(3);
  measured.force.row(2) = v.row(4) + v.row(5) + v.row(6) + v.row(7);
  measured.moment.row(0) = b * (v.row(4) + v.row(5) - v.row(6) - v.row(7));
  measured.moment.row(1) = a * (-v.row(4) + v.row(5) + v.row(6) - v.row(7));
  measured.moment.row(2) = b * (v.row(1) - v.row(0)) + a * (v.row(2) - v.row(3));
  measured.force *= plate.force_unit;
  measured.moment *= plate.force_unit;
  return measured;
}

Measured FromChannels(const ForcePlate& plate, const Eigen::MatrixXd& v) {
  switch (plate.type) {
    case PlateType::kForcesAndCop:
      return FromForcesAndCop(plate, v);
    case PlateType::kEightForces:
      return FromEightForces(plate, v);
    case PlateType::kCalibratedChannels: {
      const Eigen::MatrixXd calibrated = *plate.calibration * v;
      return {calibrated.topRows(3), plate.moment_unit * calibrated.bottomRows(3)};
    }
    case PlateType::kForcesAndMoments:
      break;
  }
  return {plate.force_unit * v.topRows(3), plate.moment_unit * v.bottomRows(3)};
}

/// From the sensors to the middle of the surface: m_s = m + f x o.
void MoveToSurface(const ForcePlate& plate, Measured* measured) {
  Eigen::Vector3d o = plate.origin;
  if (plate.type == PlateType::kForcesAndCop) return;
  if (plate.type == PlateType::kEightForces) o.head<2>().setZero();
  const Rows& f = measured->force;
  measured->moment.row(0) += f.row(1) * o.z() - f.row(2) * o.y();
  measured->moment.row(1) += f.row(2) * o.x() - f.row(0) * o.z();
  measured->moment.row(2) += f.row(0) * o.y() - f.row(1) * o.x();
}

/// How far the centre of pressure of a plate with sensors in its corners is off along one axis
/// (Kistler's polynomial, FPCOPPOLY), in the file's unit; across: the other coordinate.
double PolynomialCorrection(const Eigen::Ref<const Eigen::Matrix<double, 6, 1>>& p, double along,
                            double across) {
  const double a2 = across * across;
  const double a4 = a2 * a2;
  return (p[0] * a4 + p[1] * a2 + p[2]) * along * along * along +
         (p[3] * a4 + p[4] * a2 + p[5]) * along;
}

}  // namespace

PlateForces ForcesOfPlate(const ForcePlate& plate, const Eigen::MatrixXd& channels) {
  Measured measured = FromChannels(plate, channels);
  MoveToSurface(plate, &measured);
  const Rows& f = measured.force;
  const Rows& m = measured.moment;
  PlateForces forces;
  forces.plate = plate;
  forces.force = plate.R_WP * f;
  const Eigen::Index samples = channels.cols();
  forces.cop = Rows::Constant(3, samples, kNaN);
  forces.free_moment = Rows::Constant(3, samples, kNaN);
  if (!plate.has_moments) {
    forces.moment = Rows::Constant(3, samples, kNaN);
    return forces;
  }
  forces.moment = plate.R_WP * m;
  const Eigen::Vector3d z = plate.R_WP.col(2);
  for (Eigen::Index k = 0; k < samples; ++k) {
    if (f(2, k) == 0) continue;
    double x = -m(1, k) / f(2, k);
    double y = m(0, k) / f(2, k);
    if (plate.cop_polynomial) {
      const double u = plate.file_unit;
      const double dx = u * PolynomialCorrection(plate.cop_polynomial->col(0), x / u, y / u);
      const double dy = u * PolynomialCorrection(plate.cop_polynomial->col(1), y / u, x / u);
      x -= dx;
      y -= dy;
    }
    forces.cop.col(k) = plate.p_WP + plate.R_WP.leftCols<2>() * Eigen::Vector2d(x, y);
    forces.free_moment.col(k) = (m(2, k) - (x * f(1, k) - y * f(0, k))) * z;
  }
  return forces;
}

}  // namespace mmm_converter
