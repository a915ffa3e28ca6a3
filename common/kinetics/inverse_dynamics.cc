// SPDX-License-Identifier: MIT
#include "common/kinetics/inverse_dynamics.h"

#include <cassert>

#include "common/math/scalar_function.h"
#include "common/model/coordinate_map.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// A segment on its way, in W, where weight is an acceleration upwards.
struct MovingSegment {
  Matrix3d R = Matrix3d::Identity();
  Vector3d p = Vector3d::Zero();  // origin
  Vector3d rotation = Vector3d::Zero(), rotation_rate = Vector3d::Zero();
  Vector3d acceleration = Vector3d::Zero();                      // of the origin
  Vector3d axis = Vector3d::Zero();                              // of the joint, times f'
  Vector3d force = Vector3d::Zero(), moment = Vector3d::Zero();  // about the origin
};

/// Places the segment on its parent.
void Carry(const Segment& segment, const MovingSegment& parent, double q, double velocity,
           double acceleration, MovingSegment* moving) {
  Vector3d r = parent.R * segment.X_PF.translation();
  moving->R = parent.R * segment.X_PF.linear();
  moving->rotation = parent.rotation;
  moving->rotation_rate = parent.rotation_rate;
  Vector3d slide = Vector3d::Zero();
  if (segment.joint >= 0) {
    double value = q, slope = 1, curvature = 0;
    if (segment.function) value = segment.function->Value(q, &slope, &curvature);
    const Vector3d axis = moving->R * segment.axis;
    const double rate = slope * velocity;
    const double rate_change = slope * acceleration + curvature * velocity * velocity;
    moving->axis = slope * axis;
    if (segment.type == JointType::kSliding) {
      r += value * axis;
      slide = 2 * rate * parent.rotation.cross(axis) + rate_change * axis;
    } else {
      moving->R = moving->R * Eigen::AngleAxisd(value, segment.axis);
      moving->rotation += rate * axis;
      moving->rotation_rate += rate_change * axis + rate * parent.rotation.cross(axis);
    }
  }
  moving->p = parent.p + r;
  moving->acceleration = parent.acceleration + parent.rotation_rate.cross(r) +
                         parent.rotation.cross(parent.rotation.cross(r)) + slide;
}

/// The forces that move the segment alone.
void Push(const Segment& segment, MovingSegment* moving) {
  const Vector3d r = moving->R * segment.p_SB;
  const Vector3d& w = moving->rotation;
  moving->force =
      segment.mass * (moving->acceleration + moving->rotation_rate.cross(r) + w.cross(w.cross(r)));
  const Matrix3d inertia = moving->R * segment.inertia * moving->R.transpose();
  moving->moment = inertia * moving->rotation_rate + w.cross(inertia * w) + r.cross(moving->force);
}

}  // namespace

VectorXd InverseDynamics(const KinematicModel& model, const Posture& posture,
                         const VectorXd& velocities, const VectorXd& accelerations,
                         const std::vector<BodyWrench>& wrenches, double gravity,
                         std::vector<Vector3d>* carried) {
  assert(velocities.size() == 6 + model.num_joints());
  assert(accelerations.size() == velocities.size());
  const std::vector<Segment>& segments = model.segments();
  std::vector<MovingSegment> moving(segments.size());
  moving[0].R = posture.orientation.toRotationMatrix();
  moving[0].p = posture.position;
  moving[0].rotation = velocities.segment<3>(3);
  moving[0].rotation_rate = accelerations.segment<3>(3);
  moving[0].acceleration = accelerations.head<3>() + gravity * Vector3d::UnitZ();
  Push(segments[0], moving.data());
  for (std::size_t i = 1; i < segments.size(); ++i) {
    const Segment& segment = segments[i];
    const int j = segment.joint;
    const bool moves = j >= 0;
    Carry(segment, moving[segment.parent], moves ? posture.joint_angles[j] : 0,
          moves ? velocities[6 + j] : 0, moves ? accelerations[6 + j] : 0, &moving[i]);
    Push(segment, &moving[i]);
  }
  for (const BodyWrench& wrench : wrenches) {
    MovingSegment& on = moving[wrench.segment];
    on.force -= wrench.force;
    on.moment -= wrench.moment - on.p.cross(wrench.force);
  }
  VectorXd forces = VectorXd::Zero(velocities.size());
  for (std::size_t i = segments.size(); i-- > 1;) {
    const Segment& segment = segments[i];
    const MovingSegment& one = moving[i];
    if (segment.joint >= 0) {
      const bool slides = segment.type == JointType::kSliding;
      forces[6 + segment.joint] += one.axis.dot(slides ? one.force : one.moment);
    }
    MovingSegment& parent = moving[segment.parent];
    parent.force += one.force;
    parent.moment += one.moment + (one.p - parent.p).cross(one.force);
  }
  if (carried) {
    carried->clear();
    for (const MovingSegment& one : moving) carried->push_back(one.moment);
  }
  forces.head<3>() = moving[0].force;
  forces.segment<3>(3) = moving[0].moment;
  return forces;
}

VectorXd ForcesOfCoordinates(const KinematicModel& model, const Posture& posture,
                             const VectorXd& values, const VectorXd& forces) {
  const CoordinateMap& map = *model.coordinates();
  VectorXd result = VectorXd::Constant(values.size(), kNaN);
  Eigen::Matrix<double, 6, 1> of_root = Eigen::Matrix<double, 6, 1>::Zero();
  if (map.root()) {
    const FreeRoot& root = *map.root();
    Eigen::Matrix<double, 6, 1> v = root.offset;
    for (std::size_t i = 0; i < map.coordinates().size(); ++i) {
      const int k = map.coordinates()[i].root;
      if (k >= 0) v[k] += root.slope[k] * values[static_cast<Eigen::Index>(i)];
    }
    const Eigen::Isometry3d X_WS = Eigen::Translation3d(posture.position) * posture.orientation;
    const Vector3d p_WM = X_WS * root.X_MS.inverse().translation();
    const Vector3d force = forces.head<3>();
    const Vector3d moment = forces.segment<3>(3) + (posture.position - p_WM).cross(force);
    Matrix3d R = root.X_WF.linear();
    for (int k = 0; k < 3; ++k) {
      of_root[k] = (R * root.turns.col(k)).dot(moment);
      of_root[3 + k] = (root.X_WF.linear() * root.shifts.col(k)).dot(force);
      R = R * Eigen::AngleAxisd(v[k], root.turns.col(k));
    }
    of_root.array() *= root.slope.array();
  }
  for (std::size_t i = 0; i < map.coordinates().size(); ++i) {
    const ModelCoordinate& one = map.coordinates()[i];
    const auto at = static_cast<Eigen::Index>(i);
    if (one.root >= 0) {
      result[at] = of_root[one.root];
    } else if (one.terms.size() == 1 && one.terms.front().joint == one.name) {
      result[at] = forces[6 + model.FindJoint(one.name)];
    }
  }
  return result;
}

}  // namespace mmm_converter
