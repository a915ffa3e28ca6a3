// SPDX-License-Identifier: MIT
#include "common/dynamics/motion_dynamics.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <vector>

#include "common/model/forward_kinematics.h"
#include "common/motion/ground_rules.h"
#include "common/motion/low_pass.h"
#include "common/motion/slow_feet.h"
#include "common/motion/trajectory_derivatives.h"
#include "common/support/error.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

using Eigen::Index;
using Eigen::Matrix3Xd;
using Eigen::MatrixXd;
using Eigen::Vector3d;

/// Sets acceleration and parabola_rms. Time runs from -1 to 1 for the numbers' sake.
void FitParabola(const Eigen::Matrix3Xd& com, double rate, BallisticPhase* phase) {
  const Index n = com.cols();
  const Eigen::ArrayXd s = Eigen::ArrayXd::LinSpaced(n, -1, 1);
  Eigen::MatrixX3d basis(n, 3);
  basis << Eigen::VectorXd::Ones(n), s, s.square();
  const Eigen::Matrix3d coefficients = basis.householderQr().solve(com.transpose());
  const double half_duration = 0.5 * static_cast<double>(n - 1) / rate;
  phase->acceleration = 2 * coefficients.row(2).transpose() / (half_duration * half_duration);
  const Eigen::MatrixXd residuals = com.transpose() - basis.lazyProduct(coefficients);
  phase->parabola_rms = std::sqrt(residuals.squaredNorm() / static_cast<double>(n));
}

BallisticPhase Describe(const MotionDynamics& dynamics, const Eigen::Matrix3Xd& measured_com,
                        int begin, int end) {
  const int n = end - begin;
  BallisticPhase phase;
  phase.begin = begin;
  phase.end = end;
  FitParabola(measured_com.middleCols(begin, n), dynamics.rate, &phase);
  phase.mean_acceleration = dynamics.com_acceleration.middleCols(begin, n).rowwise().mean();
  phase.mean_force =
      dynamics.residual_force.middleCols(begin, n).colwise().norm().mean() / dynamics.body_weight();
  const Eigen::Matrix3Xd L = dynamics.angular_momentum.middleCols(begin, n);
  phase.angular_momentum = L.rowwise().mean();
  const Eigen::RowVectorXd deviations = (L.colwise() - phase.angular_momentum).colwise().norm();
  phase.angular_momentum_rms = std::sqrt(deviations.squaredNorm() / n);
  phase.angular_momentum_max = deviations.maxCoeff();
  phase.segment_angular_momentum = dynamics.segment_angular_momentum.segment(begin, n).mean();
  return phase;
}

/// The intervals of at least `shortest` seconds in which no contact body is lower than kRestHeight,
/// from a MotionDynamics that is else complete. measured_com: 3 x frames, of the motion as it is,
/// without a low-pass [m]: the parabola is a filter that suits a flight better.
std::vector<BallisticPhase> FindBallisticPhases(const MotionDynamics& dynamics,
                                                const Eigen::Matrix3Xd& measured_com,
                                                double shortest) {
  std::vector<BallisticPhase> phases;
  const int frames = dynamics.num_frames();
  // A parabola needs three frames, and one more to be a test.
  const int least = std::max(4, static_cast<int>(std::ceil(shortest * dynamics.rate)));
  int begin = 0;
  for (int k = 0; k <= frames; ++k) {
    if (k < frames && dynamics.contact_heights.col(k).minCoeff() > kRestHeight) continue;
    if (k - begin >= least) phases.push_back(Describe(dynamics, measured_com, begin, k));
    begin = k + 1;
  }
  return phases;
}

constexpr int kLeastFrames = 5;
constexpr double kLeastPressure = 0.1;  // of body weight: with less there is no centre of pressure

/// Rows of a trajectory's derivatives in the order of the model's; 0 where it has none.
MatrixXd WithAllJoints(const MatrixXd& derivatives, const std::vector<int>& joints, int all) {
  if (derivatives.size() == 0) return {};
  MatrixXd result = MatrixXd::Zero(6 + all, derivatives.cols());
  result.topRows(6) = derivatives.topRows(6);
  for (std::size_t j = 0; j < joints.size(); ++j) {
    result.row(6 + joints[j]) = derivatives.row(static_cast<Index>(6 + j));
  }
  return result;
}

/// Unknown (NaN) angles become those of the nearest frame that knows them, 0 where none does.
/// Returns the number of frames concerned.
int HoldUnknownAngles(PoseTrajectory* motion) {
  const int frames = motion->num_frames();
  std::vector<bool> held(frames, false);
  for (Index j = 0; j < static_cast<Index>(motion->joint_names.size()); ++j) {
    std::vector<int> known;
    for (int k = 0; k < frames; ++k) {
      if (std::isfinite(motion->postures[k].joint_angles[j])) known.push_back(k);
    }
    if (static_cast<int>(known.size()) == frames) continue;
    for (int k = 0; k < frames; ++k) {
      double& angle = motion->postures[k].joint_angles[j];
      if (std::isfinite(angle)) continue;
      held[k] = true;
      const auto after = std::lower_bound(known.begin(), known.end(), k);
      int nearest = after != known.end() ? *after : -1;
      if (after != known.begin() && (nearest < 0 || k - after[-1] <= nearest - k)) {
        nearest = after[-1];
      }
      angle = nearest < 0 ? 0 : motion->postures[nearest].joint_angles[j];
    }
  }
  return static_cast<int>(std::count(held.begin(), held.end(), true));
}

/// The motion with all joints of the model, in its order.
PoseTrajectory WithAllJoints(const KinematicModel& model, const PoseTrajectory& motion) {
  std::vector<int> joints;
  joints.reserve(motion.joint_names.size());
  for (const std::string& name : motion.joint_names) {
    joints.push_back(model.FindJoint(name));
    if (joints.back() < 0) {
      throw Error("the motion has joint '" + name + "', which model '" + model.name() +
                  "' does not have; use the model that the motion was made for");
    }
  }
  PoseTrajectory all;
  all.rate = motion.rate;
  all.first_time = motion.first_time;
  for (int i = 0; i < model.num_joints(); ++i) all.joint_names.push_back(model.joint(i).name);
  all.postures = motion.postures;
  for (Posture& posture : all.postures) {
    const Eigen::VectorXd angles = posture.joint_angles;
    posture.joint_angles.setZero(model.num_joints());
    for (std::size_t j = 0; j < joints.size(); ++j) {
      posture.joint_angles[joints[j]] = angles[static_cast<Index>(j)];
    }
  }
  all.velocities = WithAllJoints(motion.velocities, joints, model.num_joints());
  all.accelerations = WithAllJoints(motion.accelerations, joints, model.num_joints());
  return all;
}

/// Gives the motion its derivatives and says how.
Differentiation MakeDifferentiable(double cutoff, PoseTrajectory* motion) {
  Differentiation result;
  if (motion->velocities.size() > 0 && motion->accelerations.size() > 0) return result;
  result.source = DerivativeSource::kLowPassed;
  result.cutoff = std::min(cutoff, LargestCutoff(motion->rate));
  result.cutoff_lowered = result.cutoff < cutoff;
  if (result.cutoff > 0) *motion = LowPassed(*motion, result.cutoff);
  Differentiate(motion);
  return result;
}

/// Root mean square deviation from the mean.
double Rms(const Matrix3Xd& force) {
  const Vector3d mean = force.rowwise().mean();
  return std::sqrt((force.colwise() - mean).squaredNorm() / static_cast<double>(force.cols()));
}

/// Leaves frames [begin, end).
void Cut(int begin, int end, PoseTrajectory* motion) {
  motion->first_time = motion->time(begin);
  motion->postures = {motion->postures.begin() + begin, motion->postures.begin() + end};
  motion->standard_deviations.resize(0, 0);
  for (MatrixXd* derivatives : {&motion->velocities, &motion->accelerations}) {
    if (derivatives->size() == 0) continue;
    *derivatives = MatrixXd(derivatives->middleCols(begin, end - begin));
  }
}

/// Frames at each end of the whole motion whose accelerations nothing beyond them holds.
int UnsettledFrames(const Differentiation& differentiation, double rate) {
  if (differentiation.source == DerivativeSource::kMotion) return 0;
  if (differentiation.cutoff <= 0) return 1;
  return static_cast<int>(std::ceil(rate / differentiation.cutoff));
}

/// The force that moves the centre of mass as its second differences say; without the end frames.
Matrix3Xd RawForce(const Matrix3Xd& com, double rate, double mass) {
  const Index n = com.cols() - 2;
  Matrix3Xd force =
      mass * rate * rate * (com.rightCols(n) - 2 * com.middleCols(1, n) + com.leftCols(n));
  force.row(2).array() += mass * kGravity;
  return force;
}

/// See Differentiation::noise_force_rms; here in newtons.
double NoiseForce(const Differentiation& differentiation, const Matrix3Xd& com, double rate,
                  double mass) {
  if (differentiation.source == DerivativeSource::kMotion) return 0;
  const bool is_smooth = differentiation.cutoff > 0;
  const double cutoff =
      is_smooth ? differentiation.cutoff : std::min(DynamicsOptions().cutoff, LargestCutoff(rate));
  const Matrix3Xd smooth = LowPassed(com.transpose(), rate, cutoff).transpose();
  const double above = Rms(RawForce(com, rate, mass) - RawForce(smooth, rate, mass));
  // Second differences pass the power (2 sin(pi f / rate))^4 of the frequency f, 6 in the mean.
  const double below =
      std::sqrt(16.0 / 30) * std::pow(std::acos(-1.0), 2) * std::pow(cutoff / rate, 2.5);
  return above * (is_smooth ? std::min(1.0, below) : 1);
}

/// Sets the figures of Differentiation.
void SummarizeForces(const Matrix3Xd& measured_com, MotionDynamics* result) {
  Differentiation& differentiation = result->differentiation;
  const bool all = result->settled_begin == result->settled_end;
  const int begin = all ? 0 : result->settled_begin;
  const int frames = all ? result->num_frames() : result->settled_end - begin;
  const double weight = result->body_weight();
  const Matrix3Xd force = result->residual_force.middleCols(begin, frames);
  const Matrix3Xd raw_force = RawForce(measured_com, result->rate, result->mass);
  differentiation.force_rms = Rms(force) / weight;
  differentiation.force_peak = force.colwise().norm().maxCoeff() / weight;
  differentiation.raw_force_rms = Rms(raw_force) / weight;
  differentiation.raw_force_peak = raw_force.colwise().norm().maxCoeff() / weight;
  differentiation.noise_force_rms =
      NoiseForce(differentiation, measured_com, result->rate, result->mass) / weight;
}

void Compare(const KinematicModel& model, const WholeBodyState& simbody, const Posture& posture,
             KinematicsAgreement* agreement) {
  const std::vector<Eigen::Isometry3d> X_WS = SegmentPoses(model, posture);
  for (std::size_t i = 0; i < X_WS.size(); ++i) {
    const double distance = (X_WS[i].translation() - simbody.X_WS[i].translation()).norm();
    agreement->segment_distance = std::max(agreement->segment_distance, distance);
    // Small angles: the antisymmetric part, as acos of the trace would round to 1e-8.
    const Eigen::Matrix3d R = X_WS[i].linear().transpose() * simbody.X_WS[i].linear();
    const double sine = (R - R.transpose()).norm() / std::sqrt(8.0);
    agreement->segment_angle =
        std::max(agreement->segment_angle, std::atan2(sine, 0.5 * (R.trace() - 1)));
  }
  if (simbody.p_WM.cols() == 0) return;
  const double distance =
      (MarkerPositions(model, posture) - simbody.p_WM).colwise().norm().maxCoeff();
  agreement->marker_distance = std::max(agreement->marker_distance, distance);
}

void Resize(int frames, int joints, MotionDynamics* result) {
  for (Matrix3Xd* vectors :
       {&result->com, &result->com_velocity, &result->com_acceleration, &result->linear_momentum,
        &result->angular_momentum, &result->residual_force, &result->residual_root_moment,
        &result->residual_moment}) {
    vectors->resize(3, frames);
  }
  for (Eigen::VectorXd* scalars :
       {&result->segment_angular_momentum, &result->kinetic_energy, &result->potential_energy}) {
    scalars->resize(frames);
  }
  result->joint_torques.resize(joints, frames);
  result->joint_power.resize(joints, frames);
}

void SetFrame(int k, const WholeBodyMotion& body, const PoseTrajectory& motion,
              MotionDynamics* result) {
  const Vector3d force = body.forces.head<3>();
  const Vector3d root_moment = body.forces.segment<3>(3);
  const Vector3d from_root = body.center_of_mass - motion.postures[k].position;
  result->com.col(k) = body.center_of_mass;
  result->com_velocity.col(k) = body.center_of_mass_velocity;
  result->com_acceleration.col(k) = force / result->mass - kGravity * Vector3d::UnitZ();
  result->linear_momentum.col(k) = body.linear_momentum;
  result->angular_momentum.col(k) = body.angular_momentum;
  result->segment_angular_momentum[k] = body.segment_angular_momentum;
  result->joint_torques.col(k) = body.forces.tail(body.forces.size() - 6);
  result->joint_power.col(k) = result->joint_torques.col(k).cwiseProduct(
      motion.velocities.col(k).tail(body.forces.size() - 6));
  result->kinetic_energy[k] = body.kinetic_energy;
  result->potential_energy[k] = result->body_weight() * body.center_of_mass.z();
  result->residual_force.col(k) = force;
  result->residual_root_moment.col(k) = root_moment;
  result->residual_moment.col(k) = root_moment - from_root.cross(force);
}

/// Finds the ground by the whole motion, and keeps frames [begin, begin + frames).
GroundContact FindGround(const KinematicModel& model, const PoseTrajectory& measured,
                         const PoseTrajectory& smooth, int begin, int frames,
                         const ContactFinder& find_contacts, MotionDynamics* result) {
  result->contact_bodies = ContactBodies(model);
  const bool has_feet = HasFeet(model);
  if (has_feet) {
    const FootMotion feet = MoveFeet(model, measured);
    result->feet = find_contacts ? find_contacts(feet) : FindSlowContacts(feet);
  }
  GroundContact contact = FindGroundContact(model, result->contact_bodies, measured, smooth,
                                            has_feet ? &result->feet : nullptr);
  contact.heights = MatrixXd(contact.heights.middleCols(begin, frames));
  contact.touches = Eigen::MatrixXi(contact.touches.middleCols(begin, frames));
  contact.raised = Eigen::VectorXd(contact.raised.segment(begin, frames));
  result->ground_height = contact.ground_height;
  result->raised = contact.raised;
  result->contact_heights = contact.heights;
  result->contacts = contact.touches;
  return contact;
}

/// Where on the plane that bears the body, z = ground or above, the force would act without a
/// moment about x and y.
Eigen::Matrix2Xd CentersOfPressure(const MotionDynamics& dynamics) {
  Eigen::Matrix2Xd centers(2, dynamics.num_frames());
  for (int k = 0; k < dynamics.num_frames(); ++k) {
    const Vector3d force = dynamics.residual_force.col(k);
    const Vector3d moment = dynamics.residual_moment.col(k);
    const double height = dynamics.com(2, k) - dynamics.ground_height - dynamics.raised[k];
    const Eigen::Vector2d from_com(-moment.y() - height * force.x(),
                                   moment.x() - height * force.y());
    centers.col(k) = dynamics.com.col(k).head<2>() + from_com / force.z();
    if (force.z() < kLeastPressure * dynamics.body_weight()) {
      centers.col(k).setConstant(kNaN);
    }
  }
  return centers;
}

}  // namespace

MotionDynamics ComputeMotionDynamics(const KinematicModel& model, const PoseTrajectory& motion,
                                     const DynamicsOptions& options,
                                     const std::function<void(int, int)>& progress,
                                     const ContactFinder& find_contacts) {
  const int all_frames = motion.num_frames();
  const int begin = std::clamp(options.first_frame, 0, all_frames);
  const int frames = std::clamp(options.end_frame, begin, all_frames) - begin;
  if (frames < kLeastFrames) {
    throw Error("the motion has " + std::to_string(frames) + " frames; at least " +
                std::to_string(kLeastFrames) + " are needed for accelerations");
  }
  MotionDynamics result;
  result.mass = model.total_mass();
  if (!(result.mass > 0)) {
    throw Error("model '" + model.name() + "' has no mass, so it has no dynamics");
  }
  PoseTrajectory measured = WithAllJoints(model, motion);
  result.options = options;
  result.rate = measured.rate;
  result.joint_names = measured.joint_names;
  result.frames_with_held_joints = HoldUnknownAngles(&measured);
  PoseTrajectory smooth = measured;
  result.differentiation = MakeDifferentiable(options.cutoff, &smooth);
  const int unsettled = UnsettledFrames(result.differentiation, result.rate);
  result.settled_begin = std::clamp(unsettled - begin, 0, frames);
  result.settled_end = std::clamp(all_frames - unsettled - begin, result.settled_begin, frames);
  const GroundContact contact =
      FindGround(model, measured, smooth, begin, frames, find_contacts, &result);
  Cut(begin, begin + frames, &measured);
  Cut(begin, begin + frames, &smooth);
  result.first_time = measured.first_time;

  const SimbodyModel simbody(model);
  Matrix3Xd measured_com(3, frames);
  Resize(frames, model.num_joints(), &result);
  for (int k = 0; k < frames; ++k) {
    if (progress) progress(k, frames);
    const WholeBodyState state = simbody.At(measured.postures[k]);
    Compare(model, state, measured.postures[k], &result.kinematics);
    measured_com.col(k) = state.center_of_mass;
    SetFrame(
        k,
        simbody.Moving(smooth.postures[k], smooth.velocities.col(k), smooth.accelerations.col(k)),
        smooth, &result);
  }
  SummarizeForces(measured_com, &result);
  result.center_of_pressure = CentersOfPressure(result);
  result.outside_support = DistanceOutsideSupport(model, result.contact_bodies, smooth, contact,
                                                  result.center_of_pressure);
  result.ballistic_phases = FindBallisticPhases(result, measured_com, options.shortest_flight);
  return result;
}

}  // namespace mmm_converter
