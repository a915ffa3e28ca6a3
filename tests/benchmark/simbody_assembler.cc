// SPDX-License-Identifier: MIT
#include "tests/benchmark/simbody_assembler.h"

#include <Simbody.h>

#include <chrono>
#include <cmath>

namespace mmm_converter {
namespace {

// As OpenSim's tool for inverse kinematics asks.
constexpr double kAccuracy = 1e-5;

SimTK::Vec3 ToSimbody(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

SimTK::Transform ToSimbody(const Eigen::Isometry3d& X) {
  SimTK::Mat33 R;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) R(i, j) = X.linear()(i, j);
  }
  return {SimTK::Rotation(R), ToSimbody(X.translation())};
}

void AddBodies(const KinematicModel& model, SimTK::SimbodyMatterSubsystem* matter,
               std::vector<SimTK::MobilizedBodyIndex>* bodies) {
  const SimTK::Body::Rigid body(
      SimTK::MassProperties(1, SimTK::Vec3(0), SimTK::Inertia(0.1, 0.1, 0.1)));
  for (const Segment& segment : model.segments()) {
    if (segment.parent < 0) {
      bodies->push_back(SimTK::MobilizedBody::Free(matter->Ground(), body).getMobilizedBodyIndex());
      continue;
    }
    SimTK::MobilizedBody& parent = matter->updMobilizedBody((*bodies)[segment.parent]);
    const SimTK::Transform X_PF = ToSimbody(segment.X_PF);
    const bool is_turn = segment.type == JointType::kRevolute;
    const SimTK::Transform along(SimTK::Rotation(SimTK::UnitVec3(ToSimbody(segment.axis)),
                                                 SimTK::CoordinateAxis(is_turn ? 2 : 0)));
    if (segment.joint < 0) {
      bodies->push_back(SimTK::MobilizedBody::Weld(parent, X_PF, body, SimTK::Transform())
                            .getMobilizedBodyIndex());
    } else if (is_turn) {
      bodies->push_back(
          SimTK::MobilizedBody::Pin(parent, X_PF * along, body, along).getMobilizedBodyIndex());
    } else {
      bodies->push_back(
          SimTK::MobilizedBody::Slider(parent, X_PF * along, body, along).getMobilizedBodyIndex());
    }
  }
}

SimTK::Array_<SimTK::Vec3> Observed(const Eigen::Matrix3Xd& places) {
  SimTK::Array_<SimTK::Vec3> observed;
  for (Eigen::Index m = 0; m < places.cols(); ++m) observed.push_back(ToSimbody(places.col(m)));
  return observed;
}

}  // namespace

AssembledFrames FollowWithAssembler(const KinematicModel& model,
                                    const std::vector<Eigen::Matrix3Xd>& frames) {
  SimTK::MultibodySystem system;
  SimTK::SimbodyMatterSubsystem matter(system);
  std::vector<SimTK::MobilizedBodyIndex> bodies;
  AddBodies(model, &matter, &bodies);
  system.realizeTopology();
  SimTK::Assembler assembler(system);
  assembler.setAccuracy(kAccuracy);
  auto* markers = new SimTK::Markers();  // the assembler's
  SimTK::Array_<SimTK::Markers::MarkerIx> order;
  for (const ModelMarker& marker : model.markers()) {
    order.push_back(
        markers->addMarker(marker.name, bodies[marker.segment], ToSimbody(marker.p_SM), 1));
  }
  markers->defineObservationOrder(order);
  assembler.adoptAssemblyGoal(markers);
  assembler.initialize();
  AssembledFrames result;
  double squares = 0;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const auto start = std::chrono::steady_clock::now();
    markers->moveAllObservations(Observed(frames[k]));
    if (k == 0) {
      assembler.assemble();
      continue;
    }
    assembler.track(static_cast<double>(k));
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    result.seconds.push_back(taken.count());
    for (const SimTK::Markers::MarkerIx m : order) {
      const double error = markers->findCurrentMarkerError(m);
      squares += error * error;
    }
  }
  result.distance = std::sqrt(squares / static_cast<double>(result.seconds.size() * order.size()));
  return result;
}

}  // namespace mmm_converter
