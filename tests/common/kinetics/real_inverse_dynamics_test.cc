// SPDX-License-Identifier: MIT
// What OpenSim's inverse dynamics stored of a walk.
#include <gtest/gtest.h>

#include <cmath>

#include "common/forces/external_loads.h"
#include "common/io/bytes/file_content.h"
#include "common/io/osim/osim_model_reader.h"
#include "common/io/tables/storage_table.h"
#include "common/kinetics/inverse_dynamics.h"
#include "common/model/coordinate_map.h"
#include "common/model/forward_kinematics.h"
#include "common/motion/spline_derivatives.h"
#include "tests/support/shared_data.h"

namespace mmm_converter {
namespace {

using Eigen::VectorXd;

constexpr double kCutoff = 6;       // [Hz]
constexpr double kMotionRate = 60;  // of the motion [Hz]
const double kPi = std::acos(-1);
constexpr double kMassRatio = 0.96588;  // of the person to the generic model

StorageTable ReadTable(const std::string& file) {
  const std::string path = testing::SharedData("osim/inverse_dynamics/" + file);
  return ParseStorage(ReadFileContent(path), path);
}

Eigen::Index ColumnOf(const StorageTable& table, const std::string& name) {
  const auto at = std::find(table.columns.begin(), table.columns.end(), name);
  return at == table.columns.end() ? -1 : at - table.columns.begin();
}

/// Values of the coordinates [rad, m], a row a frame.
Eigen::MatrixXd CoordinatesOf(const KinematicModel& model, const StorageTable& table) {
  const auto& all = model.coordinates()->coordinates();
  Eigen::MatrixXd values(table.rows.rows(), static_cast<Eigen::Index>(all.size()));
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Eigen::Index column = ColumnOf(table, all[i].name);
    const double unit = all[i].kind == ModelCoordinate::Kind::kTurn ? kPi / 180 : 1;
    values.col(static_cast<Eigen::Index>(i)).setConstant(all[i].rest);
    if (column >= 0) values.col(static_cast<Eigen::Index>(i)) = unit * table.rows.col(column);
  }
  return values;
}

/// The values go on at both ends, turned about these, by half as many.
VectorXd Padded(const VectorXd& values) {
  const Eigen::Index n = values.size(), pad = n / 2;
  VectorXd y(n + 2 * pad);
  y.segment(pad, n) = values;
  for (Eigen::Index i = 1; i <= pad; ++i) {
    y[pad - i] = 2 * values[0] - values[i];
    y[pad + n - 1 + i] = 2 * values[n - 1] - values[n - 1 - i];
  }
  return y;
}

/// OpenSim's filter of coordinates: Butterworth's of third order, forth and back.
VectorXd Butterworth(const VectorXd& values) {
  VectorXd y = Padded(values);
  const double w = std::tan(kPi * kCutoff / kMotionRate);
  const Eigen::Vector2d one(1 + w, w - 1);
  const Eigen::Vector3d two(1 + w + w * w, 2 * w * w - 2, 1 - w + w * w);
  const Eigen::Vector4d a(one[0] * two[0], one[0] * two[1] + one[1] * two[0],
                          one[0] * two[2] + one[1] * two[1], one[1] * two[2]);
  for (int pass = 0; pass < 2; ++pass) {
    const VectorXd x = y;
    for (Eigen::Index i = 3; i < x.size(); ++i) {
      y[i] = (w * w * w * (x[i] + 3 * x[i - 1] + 3 * x[i - 2] + x[i - 3]) - a[1] * y[i - 1] -
              a[2] * y[i - 2] - a[3] * y[i - 3]) /
             a[0];
    }
    y = y.reverse().eval();
  }
  return y.segment(values.size() / 2, values.size());
}

/// And of the motion by which it carries points in the feet: Hamming's window of a sinc.
VectorXd Windowed(const VectorXd& values) {
  constexpr Eigen::Index kHalf = 50;
  VectorXd weights(2 * kHalf + 1);
  for (Eigen::Index k = -kHalf; k <= kHalf; ++k) {
    const auto at = static_cast<double>(k);
    const double x = 2 * kPi * kCutoff / kMotionRate * at;
    weights[k + kHalf] =
        (k == 0 ? 1 : std::sin(x) / x) * (0.54 + 0.46 * std::cos(kPi * at / kHalf));
  }
  weights /= weights.sum();
  const VectorXd padded = Padded(values);
  VectorXd y(values.size());
  for (Eigen::Index i = 0; i < y.size(); ++i) {
    y[i] = weights.dot(padded.segment(i + values.size() / 2 - kHalf, weights.size()));
  }
  return y;
}

/// The inertias with which the result was computed: those of the generic model.
KinematicModel WithGenericInertia(const KinematicModel& model) {
  const KinematicModel generic = ReadOsimModel(testing::SharedData("osim/gait2354_simbody.osim"));
  ModelDescription description = DescriptionOf(model);
  for (Segment& one : description.segments) {
    const int same = generic.FindSegment(one.name);
    if (one.mass > 0 && same >= 0) one.inertia = kMassRatio * generic.segments()[same].inertia;
  }
  return KinematicModel(description);
}

/// The forces at a frame, as the feet of `carrying` carry them to `posture`.
std::vector<BodyWrench> WrenchesAt(double time, const KinematicModel& model,
                                   const RecordedForces& forces, const Posture& carrying,
                                   const Posture& posture) {
  const auto X0 = SegmentPoses(model, carrying);
  const auto X1 = SegmentPoses(model, posture);
  std::vector<BodyWrench> wrenches;
  for (const PlateForces& one : forces.plates) {
    const auto sample = std::lround((time - forces.first_time) * forces.rate);
    const int foot = model.FindSegment(one.applied_to);
    const Eigen::Vector3d point = X1[foot] * (X0[foot].inverse() * one.cop.col(sample));
    const Eigen::Vector3d force = one.force.col(sample);
    wrenches.push_back({foot, force, point.cross(force) + one.free_moment.col(sample)});
  }
  return wrenches;
}

TEST(RealInverseDynamicsTest, IsThatOfOpenSim) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const std::string folder = "osim/inverse_dynamics/";
  const KinematicModel model =
      WithGenericInertia(ReadOsimModel(testing::SharedData(folder + "subject01.osim")));
  const StorageTable table = ReadTable("subject01_walk1_ik.mot");
  const StorageTable stored = ReadTable("std_subject01_InverseDynamics.sto");
  const Eigen::Matrix3d& R_WG = model.coordinates()->R_WG();
  RecordedForces forces = ReadExternalLoads(testing::SharedData(folder + "subject01_walk1_grf.xml"),
                                            R_WG.row(2).transpose(), nullptr);
  for (PlateForces& one : forces.plates) {
    one.force = R_WG * one.force;
    one.cop = R_WG * one.cop;
    one.free_moment = R_WG * one.free_moment;
  }

  PoseTrajectory motion;
  motion.rate = kMotionRate;
  motion.first_time = table.rows(0, 0);
  Eigen::MatrixXd values = CoordinatesOf(model, table);
  Eigen::MatrixXd carrying = values;
  for (Eigen::Index i = 0; i < values.cols(); ++i) {
    carrying.col(i) = Windowed(values.col(i));
    values.col(i) = Butterworth(values.col(i));
  }
  for (int j = 0; j < model.num_joints(); ++j) motion.joint_names.push_back(model.joint(j).name);
  for (Eigen::Index k = 0; k < values.rows(); ++k) {
    motion.postures.push_back(PostureOf(model, values.row(k).transpose()));
  }
  DifferentiateSplines(&motion);

  const auto& coordinates = model.coordinates()->coordinates();
  Eigen::MatrixXd errors = Eigen::MatrixXd::Zero(stored.rows.rows(), stored.rows.cols());
  int compared = 0;
  for (Eigen::Index row = 0; row < stored.rows.rows(); ++row) {
    const double time = stored.rows(row, 0);
    const auto k = static_cast<int>(std::lround((time - motion.first_time) * motion.rate));
    if (k < 6) continue;  // a filter knows less there
    const VectorXd joint_forces = InverseDynamics(
        model, motion.postures[k], motion.velocities.col(k), motion.accelerations.col(k),
        WrenchesAt(motion.time(k), model, forces, PostureOf(model, carrying.row(k).transpose()),
                   motion.postures[k]));
    const VectorXd found =
        ForcesOfCoordinates(model, motion.postures[k], values.row(k).transpose(), joint_forces);
    for (std::size_t i = 0; i < coordinates.size(); ++i) {
      Eigen::Index column = ColumnOf(stored, coordinates[i].name + "_moment");
      if (column < 0) column = ColumnOf(stored, coordinates[i].name + "_force");
      ASSERT_GE(column, 0) << coordinates[i].name;
      errors(row, column) = found[static_cast<Eigen::Index>(i)] - stored.rows(row, column);
    }
    ++compared;
  }
  EXPECT_GT(compared, 55);
  for (Eigen::Index column = 1; column < stored.rows.cols(); ++column) {
    const double peak = stored.rows.col(column).cwiseAbs().maxCoeff();
    EXPECT_LT(errors.col(column).cwiseAbs().maxCoeff(), 0.01 * peak)
        << stored.columns[column] << " of " << peak << ", rms "
        << std::sqrt(errors.col(column).squaredNorm() / compared);
  }
}

}  // namespace
}  // namespace mmm_converter
