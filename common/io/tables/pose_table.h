// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "common/motion/body_poses.h"
#include "common/support/text_pieces.h"

namespace mmm_converter {

/// How orientations are written.
enum class RotationForm {
  kQuaternion,      ///< w, x, y, z, without jumps of the sign
  kRotationVector,  ///< axis times angle [rad], at most pi
  kMatrix           ///< rows of the rotation matrix
};

/// "quaternion", "vector" or "matrix". @throws Error for another text, listing these.
RotationForm ParseRotationForm(const std::string& text);

/// Poses as comma-separated values, a row a frame; the header names every unit. time_s; of each
/// segment, then of each object (NAME_x_m, _y_m, _z_m) and (_qw, _qx, _qy, _qz), or (_rx_rad,
/// _ry_rad, _rz_rad), or (_r11 to _r33); of each point point_NAME_x_m, ...; com_x_m, ... where the
/// model has a mass. Then velocities where they are known: d_NAME_x_m_per_s, ... and
/// d_NAME_about_x_rad_per_s, ... of each segment, d_point_NAME_x_m_per_s, ..., d_com_x_m_per_s,
/// .... Empty cells: not known. The poses must outlive the text.
TextPieces FormatPoseCsv(const BodyPoses& poses, RotationForm rotation);

/// The same as arrays of a .npz file, float64 [m, s, rad], frames first: time (frames), rate ();
/// segments, objects, points: names; segment_positions and object_positions (frames, n, 3);
/// segment_rotations and object_rotations (frames, n, 4), (frames, n, 3) or (frames, n, 3, 3);
/// point_positions (frames, n, 3); center_of_mass (frames, 3); and where they are known
/// segment_velocities, segment_angular_velocities, point_velocities, center_of_mass_velocity.
/// frame: "world" or the root's; rotation: "quaternion wxyz", "rotation vector" or "matrix". Arrays
/// of objects are there where there are objects.
/// @throws Error as FormatNpz.
TextPieces FormatPoseNpz(const BodyPoses& poses, RotationForm rotation);

/// By the ending of the file's name, in any case: .npz, else comma-separated values.
TextPieces FormatPoseFile(const std::string& file, const BodyPoses& poses, RotationForm rotation);

}  // namespace mmm_converter
