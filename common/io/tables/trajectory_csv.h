// SPDX-License-Identifier: MIT
#pragma once

#include "common/motion/pose_trajectory.h"
#include "common/support/text_pieces.h"

namespace mmm_converter {

/// A trajectory as comma-separated values, a row a frame; the header names every unit: time_s, root
/// position [mm], root rotation (roll, pitch, yaw) [rad], joint angles [rad], then, where the
/// trajectory has them, the standard deviations of all these in the same order with the prefix
/// "sd_" (of the root's rotation: about its own x, y, z); then velocities with the prefix "d_" and
/// accelerations with "dd_", per second and per second squared (of the root's rotation: the angular
/// velocity about x, y, z of the world, and its derivative). Empty cells: not known. The trajectory
/// must outlive the text.
TextPieces FormatTrajectoryCsv(const PoseTrajectory& trajectory);

}  // namespace mmm_converter
