// SPDX-License-Identifier: MIT
#include "common/kinetics/moment_deviations.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>

#include "common/kinetics/inverse_dynamics.h"
#include "common/model/coordinate_map.h"
#include "common/motion/foot_motion.h"
#include "common/motion/low_pass.h"
#include "common/motion/marker_synthesis.h"
#include "common/motion/spline_derivatives.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kTimesASecond = 20;
constexpr double kStep = 1e-5;  // of differences [m, rad]

/// B with B B^T = P.
MatrixXd SquareRoot(const MatrixXd& P) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(P);
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal();
}

/// A factor on white noise's variance that is left out: the variance of accelerations of the rest.
double AccelerationsOfRemoved(double rate, double cutoff) {
  const auto reach = static_cast<Index>(std::ceil(4 * rate / cutoff));
  MatrixXd impulse = MatrixXd::Zero(2 * reach + 1, 1);
  impulse(reach, 0) = 1;
  const MatrixXd kept = LowPassed(impulse, rate, cutoff);
  return DifferentiateSplines(kept, rate).second.squaredNorm() / (impulse - kept).squaredNorm();
}

/// B with B B^T the covariance of the white errors' accelerations; rotations in the root's axes.
MatrixXd AccelerationErrors(const KinematicModel& model, const PoseTrajectory& motion,
                            const PoseTrajectory& smooth, double cutoff) {
  const Index size = 6 + model.num_joints();
  if (!(cutoff > 0) || motion.num_frames() == 0) return MatrixXd::Zero(size, 0);
  MatrixXd sum = MatrixXd::Zero(size, size);
  for (int k = 0; k < motion.num_frames(); ++k) {
    const VectorXd removed = Local(smooth.postures[k], ModelPosture(model, motion, k));
    sum += removed * removed.transpose();
  }
  return SquareRoot(AccelerationsOfRemoved(motion.rate, cutoff) / motion.num_frames() * sum);
}

/// Of the tracked joints, as rows of all.
std::vector<int> RowsOf(const KinematicModel& model, const PoseTrajectory& motion) {
  std::vector<int> rows = {0, 1, 2, 3, 4, 5};
  for (const std::string& name : motion.joint_names) rows.push_back(6 + model.FindJoint(name));
  return rows;
}

/// Bodies of which one segment each weighs so much more.
std::vector<KinematicModel> HeavierBodies(const KinematicModel& model, double part) {
  std::vector<KinematicModel> bodies;
  const ModelDescription usual = DescriptionOf(model);
  for (std::size_t i = 0; i < usual.segments.size(); ++i) {
    if (!(usual.segments[i].mass > 0)) continue;
    ModelDescription heavier = usual;
    heavier.segments[i].mass *= 1 + part;
    heavier.segments[i].inertia *= 1 + part;
    bodies.emplace_back(std::move(heavier));
  }
  return bodies;
}

/// What each error of one standard deviation does to the forces in a frame: a column each.
class ErrorColumns {
 public:
  ErrorColumns(const KinematicModel& model, const PoseTrajectory& motion,
               const PoseTrajectory& smooth, const FootWrenches& feet, const ForceErrors& errors,
               double cutoff)
      : model_(model),
        smooth_(smooth),
        feet_(feet),
        errors_(errors),
        rows_(RowsOf(model, motion)),
        accelerations_(AccelerationErrors(model, motion, smooth, cutoff)),
        bodies_(HeavierBodies(model, errors.mass)) {}

  MatrixXd At(int frame, const MatrixXd& covariance) {
    frame_ = frame;
    columns_.clear();
    const Posture& posture = smooth_.postures[frame];
    usual_ =
        Forces(model_, posture, smooth_.accelerations.col(frame), WrenchesAt(frame, model_, feet_));
    AddPostures(SquareRoot(covariance));
    AddAccelerations();
    const std::vector<BodyWrench> wrenches = WrenchesAt(frame, model_, feet_);
    for (const KinematicModel& body : bodies_) {
      Add(Forces(body, posture, smooth_.accelerations.col(frame), wrenches));
    }
    AddCentersOfPressure();
    MatrixXd all(usual_.size(), static_cast<Index>(columns_.size()));
    for (std::size_t i = 0; i < columns_.size(); ++i) all.col(static_cast<Index>(i)) = columns_[i];
    return all;
  }

 private:
  VectorXd Forces(const KinematicModel& body, const Posture& posture, const VectorXd& accelerations,
                  const std::vector<BodyWrench>& wrenches) const {
    return InverseDynamics(body, posture, smooth_.velocities.col(frame_), accelerations, wrenches);
  }

  void Add(const VectorXd& forces) { columns_.emplace_back(forces - usual_); }

  void AddPostures(const MatrixXd& errors) {
    const Posture& posture = smooth_.postures[frame_];
    const std::vector<BodyWrench> wrenches = WrenchesAt(frame_, model_, feet_);
    MatrixXd J(usual_.size(), errors.rows());
    for (Index i = 0; i < errors.rows(); ++i) {
      VectorXd step = VectorXd::Zero(usual_.size());
      step[rows_[static_cast<std::size_t>(i)]] = kStep;
      const VectorXd moved =
          Forces(model_, Retract(posture, step), smooth_.accelerations.col(frame_), wrenches);
      J.col(i) = (moved - usual_) / kStep;
    }
    const MatrixXd effects = J * errors;
    for (Index i = 0; i < effects.cols(); ++i) columns_.emplace_back(effects.col(i));
  }

  void AddAccelerations() {
    const Posture& posture = smooth_.postures[frame_];
    const std::vector<BodyWrench> wrenches = WrenchesAt(frame_, model_, feet_);
    for (Index i = 0; i < accelerations_.cols(); ++i) {
      VectorXd error = accelerations_.col(i);
      error.segment<3>(3) = posture.orientation * Eigen::Vector3d(error.segment<3>(3));
      Add(Forces(model_, posture, smooth_.accelerations.col(frame_) + error, wrenches));
    }
  }

  void AddCentersOfPressure() {
    const Posture& posture = smooth_.postures[frame_];
    for (std::size_t foot = 0; foot < feet_.size(); ++foot) {
      for (int axis = 0; axis < 2; ++axis) {
        std::vector<BodyWrench> wrenches = WrenchesAt(frame_, model_, feet_);
        const Eigen::Vector3d moved = errors_.center_of_pressure * Eigen::Vector3d::Unit(axis);
        wrenches[foot].moment += moved.cross(wrenches[foot].force);
        Add(Forces(model_, posture, smooth_.accelerations.col(frame_), wrenches));
      }
    }
  }

  const KinematicModel& model_;
  const PoseTrajectory& smooth_;
  const FootWrenches& feet_;
  ForceErrors errors_;
  std::vector<int> rows_;
  MatrixXd accelerations_;
  std::vector<KinematicModel> bodies_;
  int frame_ = 0;
  VectorXd usual_;
  std::vector<VectorXd> columns_;
};

/// Of the forces of coordinates, or of joints.
VectorXd DeviationsOf(const MatrixXd& effects, const KinematicModel& model, const Posture& posture,
                      const VectorXd& values) {
  if (!model.coordinates()) {
    return effects.bottomRows(model.num_joints()).rowwise().norm();
  }
  VectorXd squares = VectorXd::Zero(values.size());
  for (Index i = 0; i < effects.cols(); ++i) {
    squares += ForcesOfCoordinates(model, posture, values, effects.col(i)).cwiseAbs2();
  }
  return squares.cwiseSqrt();
}

}  // namespace

void EstimateDeviations(const KinematicModel& model, const PoseTrajectory& motion,
                        const Contacts& contacts, const RecordedForces& forces,
                        const std::vector<PoseCovariance>& covariances, const ForceErrors& errors,
                        JointForces* found) {
  assert(!covariances.empty());
  const PoseTrajectory smooth = SmoothMotion(model, motion, found->cutoff);
  const int frames = motion.num_frames();
  const FootWrenches feet =
      WrenchesOnFeet(contacts, forces, {motion.rate, motion.first_time, frames}, found->cutoff);
  ErrorColumns columns(model, motion, smooth, feet, errors, found->cutoff);
  std::optional<CoordinateSeries> coordinates;
  if (model.coordinates()) coordinates.emplace(model);
  const int every = std::max(1, static_cast<int>(motion.rate / kTimesASecond));
  found->deviations.setConstant(found->forces.rows(), frames, kNaN);
  std::size_t of_frame = 0;
  int before = -1;
  for (int k = 0; k < frames; ++k) {
    const VectorXd values = coordinates ? coordinates->Next(smooth.postures[k]) : VectorXd();
    if (k % every != 0 && k != frames - 1) continue;
    while (of_frame + 1 < covariances.size() && covariances[of_frame + 1].frame <= k) ++of_frame;
    found->deviations.col(k) = DeviationsOf(columns.At(k, covariances[of_frame].covariance), model,
                                            smooth.postures[k], values);
    for (int i = before + 1; before >= 0 && i < k; ++i) {
      const double share = static_cast<double>(i - before) / (k - before);
      found->deviations.col(i) =
          (1 - share) * found->deviations.col(before) + share * found->deviations.col(k);
    }
    before = k;
  }
  found->deviations = found->forces.array().isNaN().select(kNaN, found->deviations);
}

}  // namespace mmm_converter
