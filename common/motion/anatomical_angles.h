// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "common/model/kinematic_model.h"
#include "common/motion/pose_trajectory.h"

namespace mmm_converter {

/// An angle by the name that people have for it.
struct AnatomicalAngle {
  const char* joint = "";   ///< "pelvis", "trunk", "neck", "hip", "knee", "ankle", "shoulder", ...
  const char* side = "";    ///< "left", "right"; empty: of the middle of the body
  const char* motion = "";  ///< "flexion": the direction in which it grows
};

/// Angles of the joints as segments turn against each other (Grood and Suntay 1983; ISB): about the
/// axis to the left of the proximal segment, then about the forward axis between, then along the
/// distal segment. All are 0 where the model stands with hanging arms and palms to the body.
///   pelvis    against the laboratory, in the order of Baker (2001): tilt (forward), obliquity (the
///             left side up), rotation (to the left)
///   trunk, neck   flexion (forward), lateral bending (to the right), rotation (to the left) of the
///             thorax against the pelvis, of the head against the thorax
///   hip, shoulder   flexion, adduction, internal rotation
///   knee      flexion; of a model that has them adduction and internal rotation
///   ankle     dorsiflexion, inversion, internal rotation of the foot against the shank
///   elbow     flexion; pronation from where the palm looks to the body
///   wrist     flexion (about the forward axis), radial deviation
/// An angle that no joint of the model can change is not there. Flexion of an arm that is abducted
/// by 90 degrees is not determined, nor is its rotation.
struct AnatomicalAngles {
  double rate = 0;        ///< [Hz]
  double first_time = 0;  ///< [s]
  std::vector<AnatomicalAngle> angles;
  std::vector<std::vector<int>>
      joints;  ///< of the model, by which each angle changes; empty: the root
  Eigen::Vector2d forward = Eigen::Vector2d::UnitY();  ///< where a pelvis without rotation faces, W
  Eigen::MatrixXd values;                              ///< angles x frames [rad], without jumps
  Eigen::MatrixXd deviations;  ///< standard deviations [rad]; empty: the motion has none

  int num_frames() const { return static_cast<int>(values.cols()); }
  double time(int k) const { return first_time + k / rate; }
};

/// Whether a model has a pelvis and legs of MMM's reference model or of OpenSim's persons.
bool HasAnatomy(const KinematicModel& model);

/// Joints that the motion does not name are as in ZeroPosture. @throws Error where HasAnatomy is
/// false.
AnatomicalAngles ComputeAnatomicalAngles(const KinematicModel& model, const PoseTrajectory& motion);

/// These rows of them.
AnatomicalAngles SomeOf(const AnatomicalAngles& angles, const std::vector<Eigen::Index>& rows);

/// Moments about the axes of these angles, a row for each: times the angles' rates they are the
/// power of the joints. joint_forces: generalised forces, the model's joints x the motion's frames
/// [N m]; NaN: not known, nor are moments that need it, nor those of the pelvis.
Eigen::MatrixXd AnatomicalMoments(const KinematicModel& model, const PoseTrajectory& motion,
                                  const Eigen::MatrixXd& joint_forces);

/// An axis about which a knee of the model can't turn, and holds.
struct HeldAxis {
  AnatomicalAngle angle;   ///< that would grow by a turn about it
  int segment = 0;         ///< the shank
  Eigen::Vector3d axis_S;  ///< of the shank
};
std::vector<HeldAxis> FindHeldAxes(const KinematicModel& model);

/// The moments about these axes that would make their angles grow [N m], a row for each. held: for
/// each axis the whole moment by which the knee holds its shank (W) [N m], 3 x frames.
Eigen::MatrixXd HeldMoments(const KinematicModel& model, const PoseTrajectory& motion,
                            const std::vector<HeldAxis>& axes,
                            const std::vector<Eigen::Matrix3Xd>& held);

}  // namespace mmm_converter
