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
  // A pin turns about the z axes of two frames: both are laid along our axis.
  const SimTK::Transform along_axis(
      SimTK::Rotation(SimTK::UnitVec3(ToSimbody(segment.axis)), SimTK::ZAxis));
  bodies.push_back(SimTK::MobilizedBody::Pin(parent, X_PF * along_axis, body, along_axis)
                       .getMobilizedBodyIndex());
}

SimbodyModel::SimbodyModel(const KinematicModel& model) : system_(new System(model)) {
  for (const Segment& segment : model.segments()) system_->AddSegment(segment);
  system_->multibody.realizeTopology();
}

SimbodyModel::~SimbodyModel() = default;

WholeBodyState SimbodyModel::At(const Posture& posture) const {
  const System& system = *system_;
  assert(posture.joint_angles.size() == system.model.num_joints());
  SimTK::State state = system.multibody.getDefaultState();
  Eigen::Isometry3d X_WR = Eigen::Isometry3d::Identity();
  X_WR.translate(posture.position).rotate(posture.orientation);
  system.matter.getMobilizedBody(system.bodies[0]).setQToFitTransform(state, ToSimbody(X_WR));
  for (int i = 0; i < system.model.num_joints(); ++i) {
    system.matter.getMobilizedBody(system.bodies[system.model.joint_segment(i)])
        .setOneQ(state, 0, posture.joint_angles[i]);
  }
  system.multibody.realize(state, SimTK::Stage::Position);

  WholeBodyState result;
  for (const SimTK::MobilizedBodyIndex index : system.bodies) {
    const SimTK::Transform& X = system.matter.getMobilizedBody(index).getBodyTransform(state);
    Eigen::Isometry3d& X_WS = result.X_WS.emplace_back(Eigen::Isometry3d::Identity());
    X_WS.linear() = FromSimbody(X.R().asMat33());
    X_WS.translation() = FromSimbody(X.p());
  }
  result.p_WM.resize(3, static_cast<Eigen::Index>(system.model.markers().size()));
  for (Eigen::Index i = 0; i < result.p_WM.cols(); ++i) {
    const ModelMarker& marker = system.model.markers()[i];
    result.p_WM.col(i) =
        FromSimbody(system.matter.getMobilizedBody(system.bodies[marker.segment])
                        .findStationLocationInGround(state, ToSimbody(marker.p_SM)));
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

}  // namespace mmm_converter
