// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <numbers>
#include <string>

#include "common/kinetics/joint_forces.h"

namespace mmm_converter::testing {

inline Segment BodyPart(const std::string& name, int parent, const Eigen::Vector3d& place,
                        double mass, const Eigen::Vector3d& axis = -Eigen::Vector3d::UnitY()) {
  Segment part;
  part.name = name;
  part.parent = parent;
  part.X_PF.translation() = place;
  part.mass = mass;
  part.inertia = mass * Eigen::Vector3d(0.01, 0.01, 0.01).asDiagonal();
  if (parent >= 0) {
    part.type = JointType::kRevolute;
    part.axis = axis;
    part.lower = -3;
    part.upper = 3;
  }
  return part;
}

/// A trunk on two straight legs, which looks along x: 54 kg.
inline KinematicModel MadePerson() {
  ModelDescription description;
  description.name = "person";
  description.segments.push_back(BodyPart("pelvis", -1, {0, 0, 0}, 34));
  for (const char side : {'l', 'r'}) {
    const double y = side == 'l' ? 0.1 : -0.1;
    const auto root = static_cast<int>(description.segments.size());
    const auto name = [side](const char* of) { return std::string(of) + "_" + side; };
    description.segments.push_back(BodyPart(name("hip"), 0, {0, y, 0}, 6));
    description.segments.push_back(BodyPart(name("knee"), root, {0, 0, -0.4}, 3));
    description.segments.push_back(BodyPart(name("calcn"), root + 1, {0, 0, -0.4}, 1));
    description.segments.push_back(BodyPart(name("toes"), root + 2, {0.15, 0, -0.05}, 0));
  }
  return KinematicModel(description);
}

/// Swings on its right foot, which a plate bears all the time with what the motion needs.
struct MadeWalker {
  KinematicModel model = MadePerson();
  PoseTrajectory motion;
  Contacts contacts;
  RecordedForces forces;

  MadeWalker() {
    constexpr double kRate = 100;
    constexpr int kFrames = 200;
    motion.rate = forces.rate = kRate;
    for (int j = 0; j < model.num_joints(); ++j) motion.joint_names.push_back(model.joint(j).name);
    for (int k = 0; k < kFrames; ++k) {
      const double t = k / kRate;
      const auto wave = [t](double size, double phase) {
        return size * std::sin(2 * std::numbers::pi * t + phase);
      };
      Posture posture = ZeroPosture(model);
      posture.position = {0.2 * t, wave(0.02, 1), 0.85 + wave(0.02, 2)};
      posture.orientation = Eigen::AngleAxisd(wave(0.1, 0.5), Eigen::Vector3d::UnitZ());
      for (int j = 0; j < model.num_joints(); ++j) posture.joint_angles[j] = wave(0.3, 0.9 * j);
      motion.postures.push_back(posture);
    }
    PlateForces plate;
    plate.force.resize(3, kFrames);
    plate.moment = plate.cop = plate.free_moment = Eigen::Matrix3Xd::Zero(3, kFrames);
    const PoseTrajectory smooth = SmoothMotion(model, motion, 0);
    for (int k = 0; k < kFrames; ++k) {
      const Eigen::VectorXd needed = InverseDynamics(
          model, smooth.postures[k], smooth.velocities.col(k), smooth.accelerations.col(k), {});
      const Eigen::Vector3d force = needed.head<3>();
      plate.force.col(k) = force;
      plate.moment.col(k) = needed.segment<3>(3) + smooth.postures[k].position.cross(force);
    }
    forces.plates = {plate};
    PlateLoad load;
    load.samples = {0, kFrames};
    load.end = kFrames / kRate;
    load.bearer = Bearer::kRight;
    contacts.loads = {load};
    contacts.contacts = {{Side::kRight, {}, {}, 0, 0, {1}}};
  }
};

}  // namespace mmm_converter::testing
