// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "common/io/c3d/c3d_analog.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// What a plate's channels are, as the C3D user guide numbers them (FORCE_PLATFORM:TYPE).
enum class PlateType {
  kForcesAndCop = 1,       ///< Fx Fy Fz Px Py Tz
  kForcesAndMoments = 2,   ///< Fx Fy Fz Mx My Mz
  kEightForces = 3,        ///< fx12 fx34 fy14 fy23 fz1 fz2 fz3 fz4
  kCalibratedChannels = 4  ///< six raw channels, of which a matrix makes forces and moments
};

/// A force plate in the laboratory. W: the axes of the file. P: the plate's own, from the middle of
/// its surface, z down.
struct ForcePlate {
  int number = 1;  ///< counted from 1, as the file has them
  PlateType type = PlateType::kForcesAndMoments;
  std::vector<int> channels;  ///< of the file, counted from 0, in the order of PlateType
  Eigen::Matrix3d R_WP = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p_WP = Eigen::Vector3d::Zero();       ///< [m]
  Eigen::Matrix<double, 3, 4> corners;                  ///< p_W, in the file's order [m]
  Eigen::Vector2d half_size = Eigen::Vector2d::Zero();  ///< along x and y of P [m]
  /// From where channels are measured to P's origin, in P [m]; of eight forces x and y are the
  /// distances of the sensors.
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  std::optional<Eigen::Matrix<double, 6, 6>> calibration;     ///< moments in N x file unit
  std::optional<Eigen::Matrix<double, 6, 2>> cop_polynomial;  ///< in file units
  double file_unit = 1e-3;                                    ///< [m]
  double force_unit = 1;                                      ///< of the channels [N]
  double moment_unit = 1e-3;                                  ///< of the channels [N m]
  bool is_origin_sign_known = true;  ///< false: its z is 0, and x and y may stand either way
  bool has_moments = true;           ///< false: forces alone, as the sensors' places are not stated
};

/// Sets R_WP, p_WP and half_size from the corners; false: they do not span a surface.
bool PlaceBetweenCorners(ForcePlate* plate);

/// The plates of a file that can be read; the others are refused in a warning that names the plate
/// and the reason. unit [m]: of lengths. Corners 1 to 4 lie at (+x, +y), (-x, +y), (-x, -y), (+x,
/// -y) of P.
std::vector<ForcePlate> ReadForcePlates(const C3dFile& file, const C3dAnalog& analog, double unit,
                                        Warnings* warnings);

}  // namespace mmm_converter
