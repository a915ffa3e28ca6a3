// SPDX-License-Identifier: MIT
#pragma once

#include "common/model/kinematic_model.h"
#include "common/motion/pose_trajectory.h"
#include "common/support/text_pieces.h"

namespace mmm_converter {

/// Of lengths in a BVH file, which does not say it.
enum class BvhUnit { kCentimetres, kMetres };

/// A motion as BVH (Biovision hierarchy): a skeleton and its joint rotations, for Blender and
/// programs that transfer motions to characters. y is up, x, y, z of the file are x, z, -y of W;
/// offsets and the root's position are in the unit, angles in degrees.
///
/// The root is Hips; joints are those of the trajectory (and the collar bones of the MMM model),
/// successive ones at one place as one joint, with channels Zrotation Xrotation Yrotation: R = Rz
/// Rx Ry. Joints of the MMM model have the names that such programs know (Spine, LeftArm, ...),
/// others their own without "_joint". With all channels 0 the model is as with all joint angles 0,
/// and all joints' axes are the world's. Ends of limbs have an End Site at what is farthest.
/// Postures must be finite. Model and trajectory must outlive the text.
/// @throws Error where the trajectory names a joint that the model does not have.
TextPieces FormatBvh(const KinematicModel& model, const PoseTrajectory& trajectory,
                     BvhUnit unit = BvhUnit::kCentimetres);

}  // namespace mmm_converter
