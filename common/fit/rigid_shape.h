// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "common/motion/marker_sequence.h"

namespace mmm_converter {

/// The pose X_WO that brings the points p_OM nearest to z, by weighted squared distance (Kabsch
/// 1976, without reflection). Both are 3 x points [m]; weights: one each; points that are NaN in z
/// do not count. Three points off a line determine it. Allocates nothing.
Eigen::Isometry3d FitRigidPose(const Eigen::Ref<const Eigen::Matrix3Xd>& p_OM,
                               const Eigen::Ref<const Eigen::Matrix3Xd>& z,
                               const Eigen::Ref<const Eigen::VectorXd>& weights);

/// Distance of the finite ones of some points (3 x points, at least one finite) from their mean:
/// the root mean square [m].
double RadiusOf(const Eigen::Ref<const Eigen::Matrix3Xd>& points);

/// Distance of the finite ones of some points (3 x points) from the line that is nearest to them:
/// the root mean square [m]. 0 for fewer than three.
double DistanceFromLine(const Eigen::Ref<const Eigen::Matrix3Xd>& points);

/// Markers that stray from their places by more than this share of the shape's root mean square
/// radius are no rigid body.
inline constexpr double kMostStray = 0.1;

/// How the markers of a rigid object stand to each other.
struct RigidShape {
  std::vector<int> labels;  ///< of the recording, by index; those whose place is known
  /// Their places, 3 x labels [m]. O: the origin is their mean, the axes are those of the world in
  /// the first of the frames that show most of the markers.
  Eigen::Matrix3Xd p_OM;
  int frames = 0;       ///< that it was taken from
  double distance = 0;  ///< of the markers of these frames from it, root mean square [m]
};

/// The shape by which all markers of a recording move as one rigid body: generalised Procrustes
/// analysis over at most 1000 frames that show three or more, spread evenly over the recording, and
/// 20 for each marker that these hardly show. Markers need not be seen together as long as others
/// link them. Frames whose distances between markers differ from
/// the usual ones (the medians over the recording), such as those with swapped labels, do not
/// count.
/// @throws Error where there are fewer than three markers, no frame shows three of them, they stand
///         on a line, or do not move as a rigid body.
RigidShape EstimateRigidShape(const MarkerSequence& recording);

}  // namespace mmm_converter
