// SPDX-License-Identifier: MIT
#include "common/dynamics/simbody_model.h"

#include <Simbody.h>

#include <cassert>
#include <limits>
#include <string>

#include "common/support/error.h"

namespace mmm_converter {
namespace {

SimTK::Vec3 ToSimbody(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

SimTK::Transform ToSimbody(const Eigen::Isometry3d& X) {
  SimTK::Mat33 R;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) R(row, column) = X.linear()(row, column);
  }
  return {SimTK::Rotation(R), ToSimbody(X.translation())};
}

Eigen::Matrix3d FromSimbody(const SimTK::Mat33& matrix) {
  Eigen::Matrix3d copy;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) copy(row, column) = matrix(row, column);
  }
  return copy;
}

Eigen::Vector3d FromSimbody(const SimTK::Vec3& v) { return {v[0], v[1], v[2]}; }

SimTK::Body::Rigid MakeBody(const Segment& segment) {
  if (segment.mass <= 0) {
    return SimTK::Body::Rigid(SimTK::MassProperties(0, SimTK::Vec3(0), SimTK::Inertia(0)));
  }
  const Eigen::Matrix3d& I = segment.inertia;
  const SimTK::SymMat33 central(I(0, 0),           //
                                I(1, 0), I(1, 1),  //
                                I(2, 0), I(2, 1), I(2, 2));
  if (!SimTK::Inertia::isValidInertiaMatrix(central)) {
    throw Error("model node '" + segment.name +
                "': no body has its inertia; each of three moments must be at most the sum of the "
                "other two");
  }
  const SimTK::Vec3 p_SB = ToSimbody(segment.p_SB);
  return SimTK::Body::Rigid(SimTK::MassProperties(
      segment.mass, p_SB, SimTK::Inertia(central).shiftFromMassCenter(p_SB, segment.mass)));
}

}  // namespace

struct SimbodyModel::System {
  explicit System(const KinematicModel& kinematic_model)
      : model(kinematic_model), matter(multibody) {}

  void AddSegment(const Segment& segment);
  SimTK::State At(const Posture& posture) const;
  SimTK::State Moving(const Posture& posture, const Eigen::VectorXd& velocities) const;
  SimTK::Vector_<SimTK::SpatialVec> Weights(const SimTK::State& state) const;
  SimTK::Vector InOrder(const Eigen::VectorXd& accelerations, const Posture& posture,
                        const Eigen::VectorXd& velocities, const SimTK::State& state) const;
  SimTK::Vector InOrder(const Eigen::VectorXd& forces, const SimTK::State& state) const;
  Eigen::VectorXd OutOfOrder(const SimTK::Vector& theirs, const Posture& posture,
                             const SimTK::State& state) const;

  const SimTK::MobilizedBody& body(int segment) const {
    return matter.getMobilizedBody(bodies[segment]);
  }
  SimTK::UIndex rate_index(std::size_t segment, const SimTK::State& state) const {
    return body(static_cast<int>(segment)).getFirstUIndex(state);
  }
  /// What a joint of the posture turns its segment by, or shifts it: f(q) with its derivatives.
  struct JointFunction {
    double value, slope = 1, curvature = 0;
  };
  JointFunction FunctionOf(const Segment& segment, const Posture& posture) const;

  KinematicModel model;
  SimTK::MultibodySystem multibody;
  SimTK::SimbodyMatterSubsystem matter;
  std::vector<SimTK::MobilizedBodyIndex> bodies;  ///< of each segment
};

void SimbodyModel::System::AddSegment(const Segment& segment) {
  const SimTK::Body::Rigid body = MakeBody(segment);
  if (segment.parent < 0) {
    bodies.push_back(SimTK::MobilizedBody::Free(matter.Ground(), body).getMobilizedBodyIndex());
    return;
  }
  SimTK::MobilizedBody& parent = matter.updMobilizedBody(bodies[segment.parent]);
  const SimTK::Transform X_PF = ToSimbody(segment.X_PF);
  if (segment.joint < 0) {
    bodies.push_back(
        SimTK::MobilizedBody::Weld(parent, X_PF, body, SimTK::Transform()).getMobilizedBodyIndex());
    return;
  }
  if (segment.type == JointType::kSliding) {
    const SimTK::Transform along_axis(
        SimTK::Rotation(SimTK::UnitVec3(ToSimbody(segment.axis)), SimTK::XAxis));
    bodies.push_back(SimTK::MobilizedBody::Slider(parent, X_PF * along_axis, body, along_axis)
                         .getMobilizedBodyIndex());
    return;
  }
  // A pin turns about the z axes of two frames: both are laid along our axis.
  const SimTK::Transform along_axis(
      SimTK::Rotation(SimTK::UnitVec3(ToSimbody(segment.axis)), SimTK::ZAxis));
  bodies.push_back(SimTK::MobilizedBody::Pin(parent, X_PF * along_axis, body, along_axis)
                       .getMobilizedBodyIndex());
}

SimbodyModel::System::JointFunction SimbodyModel::System::FunctionOf(const Segment& segment,
                                                                     const Posture& posture) const {
  JointFunction found{posture.joint_angles[segment.joint]};
  if (segment.function) {
    found.value = segment.function->Value(found.value, &found.slope, &found.curvature);
  }
  return found;
}

SimTK::State SimbodyModel::System::At(const Posture& posture) const {
  assert(posture.joint_angles.size() == model.num_joints());
  SimTK::State state = multibody.getDefaultState();
  Eigen::Isometry3d X_WR = Eigen::Isometry3d::Identity();
  X_WR.translate(posture.position).rotate(posture.orientation);
  body(0).setQToFitTransform(state, ToSimbody(X_WR));
  for (std::size_t i = 1; i < bodies.size(); ++i) {
    const Segment& segment = model.segments()[i];
    if (segment.joint < 0) continue;
    body(static_cast<int>(i)).setOneQ(state, 0, FunctionOf(segment, posture).value);
  }
  multibody.realize(state, SimTK::Stage::Position);
  return state;
}

SimTK::State SimbodyModel::System::Moving(const Posture& posture,
                                          const Eigen::VectorXd& velocities) const {
  assert(velocities.size() == 6 + model.num_joints());
  // Not state.updU(): like all of State's inline functions it asks that NDEBUG is as it was where
  // the library was compiled, which Debian's was not.
  SimTK::State state = At(posture);
  for (int i = 0; i < 3; ++i) {
    body(0).setOneU(state, i, velocities[3 + i]);
    body(0).setOneU(state, 3 + i, velocities[i]);
  }
  for (std::size_t i = 1; i < bodies.size(); ++i) {
    const Segment& segment = model.segments()[i];
    if (segment.joint < 0) continue;
    body(static_cast<int>(i))
        .setOneU(state, 0, FunctionOf(segment, posture).slope * velocities[6 + segment.joint]);
  }
  multibody.realize(state, SimTK::Stage::Velocity);
  return state;
}

/// Ours: root position, root rotation (W), joints. Simbody's Free mobilizer on the ground has the
/// angular velocity (W) first, then the velocity of its origin; so has every dual of it.
SimTK::Vector SimbodyModel::System::InOrder(const Eigen::VectorXd& accelerations,
                                            const Posture& posture,
                                            const Eigen::VectorXd& velocities,
                                            const SimTK::State& state) const {
  SimTK::Vector theirs = InOrder(accelerations, state);
  for (std::size_t i = 1; i < bodies.size(); ++i) {
    const Segment& segment = model.segments()[i];
    if (segment.joint < 0) continue;
    const JointFunction function = FunctionOf(segment, posture);
    const double speed = velocities[6 + segment.joint];
    theirs[rate_index(i, state)] =
        function.slope * accelerations[6 + segment.joint] + function.curvature * speed * speed;
  }
  return theirs;
}

SimTK::Vector SimbodyModel::System::InOrder(const Eigen::VectorXd& ours,
                                            const SimTK::State& state) const {
  assert(ours.size() == 6 + model.num_joints());
  SimTK::Vector theirs(matter.getNumMobilities(), 0.0);
  const int root = body(0).getFirstUIndex(state);
  for (int i = 0; i < 3; ++i) {
    theirs[root + i] = ours[3 + i];
    theirs[root + 3 + i] = ours[i];
  }
  for (int i = 0; i < model.num_joints(); ++i) {
    theirs[rate_index(static_cast<std::size_t>(model.joint_segment(i)), state)] = ours[6 + i];
  }
  return theirs;
}

/// Forces. Those on bodies that follow a joint are its own, too.
Eigen::VectorXd SimbodyModel::System::OutOfOrder(const SimTK::Vector& theirs,
                                                 const Posture& posture,
                                                 const SimTK::State& state) const {
  Eigen::VectorXd ours = Eigen::VectorXd::Zero(6 + model.num_joints());
  const int root = body(0).getFirstUIndex(state);
  for (int i = 0; i < 3; ++i) {
    ours[3 + i] = theirs[root + i];
    ours[i] = theirs[root + 3 + i];
  }
  for (std::size_t i = 1; i < bodies.size(); ++i) {
    const Segment& segment = model.segments()[i];
    if (segment.joint < 0) continue;
    ours[6 + segment.joint] += FunctionOf(segment, posture).slope * theirs[rate_index(i, state)];
  }
  return ours;
}

SimTK::Vector_<SimTK::SpatialVec> SimbodyModel::System::Weights(const SimTK::State& state) const {
  SimTK::Vector_<SimTK::SpatialVec> forces(matter.getNumBodies(),
                                           SimTK::SpatialVec(SimTK::Vec3(0)));
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Segment& segment = model.segments()[i];
    matter.addInStationForce(state, bodies[i], ToSimbody(segment.p_SB),
                             SimTK::Vec3(0, 0, -segment.mass * kGravity), forces);
  }
  return forces;
}

SimbodyModel::SimbodyModel(const KinematicModel& model) : system_(new System(model)) {
  for (const Segment& segment : model.segments()) system_->AddSegment(segment);
  system_->multibody.realizeTopology();
}

SimbodyModel::~SimbodyModel() = default;

WholeBodyState SimbodyModel::At(const Posture& posture) const {
  const System& system = *system_;
  const SimTK::State state = system.At(posture);

  WholeBodyState result;
  result.X_WS.reserve(system.bodies.size());
  for (const SimTK::MobilizedBodyIndex index : system.bodies) {
    const SimTK::Transform& X = system.matter.getMobilizedBody(index).getBodyTransform(state);
    Eigen::Isometry3d& X_WS = result.X_WS.emplace_back(Eigen::Isometry3d::Identity());
    X_WS.linear() = FromSimbody(X.R().asMat33());
    X_WS.translation() = FromSimbody(X.p());
  }
  result.p_WM.resize(3, static_cast<Eigen::Index>(system.model.markers().size()));
  for (Eigen::Index i = 0; i < result.p_WM.cols(); ++i) {
    const ModelMarker& marker = system.model.markers()[i];
    result.p_WM.col(i) = FromSimbody(
        system.body(marker.segment).findStationLocationInGround(state, ToSimbody(marker.p_SM)));
  }
  result.mass = system.matter.calcSystemMass(state);
  result.center_of_mass.setConstant(std::numeric_limits<double>::quiet_NaN());
  result.central_inertia.setZero();
  if (result.mass > 0) {
    result.center_of_mass = FromSimbody(system.matter.calcSystemMassCenterLocationInGround(state));
    result.central_inertia =
        FromSimbody(system.matter.calcSystemCentralInertiaInGround(state).toMat33());
  }
  return result;
}

WholeBodyMotion SimbodyModel::Moving(const Posture& posture, const Eigen::VectorXd& velocities,
                                     const Eigen::VectorXd& accelerations) const {
  const System& system = *system_;
  const SimTK::SimbodyMatterSubsystem& matter = system.matter;
  const SimTK::State state = system.Moving(posture, velocities);
  const SimTK::Vec3 p = matter.calcSystemMassCenterLocationInGround(state);
  const SimTK::Vec3 v = matter.calcSystemMassCenterVelocityInGround(state);
  const SimTK::SpatialVec momentum = matter.calcSystemCentralMomentum(state);

  WholeBodyMotion result;
  result.center_of_mass = FromSimbody(p);
  result.center_of_mass_velocity = FromSimbody(v);
  result.angular_momentum = FromSimbody(momentum[0]);
  result.linear_momentum = FromSimbody(momentum[1]);
  for (const SimTK::MobilizedBodyIndex index : system.bodies) {
    const SimTK::MobilizedBody& body = matter.getMobilizedBody(index);
    const SimTK::SpatialVec own = body.calcBodyMomentumAboutBodyMassCenterInGround(state);
    const SimTK::Vec3 from_center = body.findMassCenterLocationInGround(state) - p;
    const SimTK::Vec3 relative = own[1] - body.getBodyMass(state) * v;
    result.segment_angular_momentum += (own[0] + SimTK::cross(from_center, relative)).norm();
  }
  result.kinetic_energy = matter.calcKineticEnergy(state);
  SimTK::Vector forces;
  matter.calcResidualForceIgnoringConstraints(
      state, SimTK::Vector(), system.Weights(state),
      system.InOrder(accelerations, posture, velocities, state), forces);
  result.forces = system.OutOfOrder(forces, posture, state);
  return result;
}

Eigen::VectorXd SimbodyModel::Accelerations(const Posture& posture,
                                            const Eigen::VectorXd& velocities,
                                            const Eigen::VectorXd& forces) const {
  const System& system = *system_;
  const SimTK::State state = system.Moving(posture, velocities);
  system.multibody.realize(state, SimTK::Stage::Dynamics);
  SimTK::Vector accelerations;
  SimTK::Vector_<SimTK::SpatialVec> of_bodies;
  system.matter.calcAccelerationIgnoringConstraints(
      state, system.InOrder(forces, state), system.Weights(state), accelerations, of_bodies);
  return system.OutOfOrder(accelerations, posture, state);
}

}  // namespace mmm_converter
