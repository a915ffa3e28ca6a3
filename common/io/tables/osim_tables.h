// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "common/model/kinematic_model.h"
#include "common/motion/pose_trajectory.h"
#include "common/support/text_pieces.h"

namespace mmm_converter {

// Tables as OpenSim's tools write and read them (.mot, .sto): tab separated, time in seconds, in
// the axes of the model's ground (y up, where the model is not one of OpenSim). Postures must be
// finite. Models, errors and trajectories must outlive the texts.

/// All coordinates of a model that has coordinates(), with those that are locked or follow others,
/// as its inverse kinematics writes them: turns in degrees, all else in metres and radians.
TextPieces FormatOsimMotion(const KinematicModel& model, const PoseTrajectory& trajectory);

/// How tables of FormatOsimDeviations begin.
inline constexpr const char* kOsimDeviations = "Standard deviations of coordinates";

/// The standard deviations of such a model's coordinates, in their units. Coordinates that the
/// tracker says nothing of are 0 where they are constant, else nan.
TextPieces FormatOsimDeviations(const KinematicModel& model, const PoseTrajectory& trajectory);

/// Where the model has its markers [m], NAME_tx, NAME_ty and NAME_tz of each.
TextPieces FormatOsimMarkers(const KinematicModel& model, const PoseTrajectory& trajectory,
                             const std::vector<MarkerIx>& markers);

/// How far the model's markers are from the measured ones [m]: total_squared_error,
/// marker_error_RMS and marker_error_max of each frame, then of each marker that is seen; from the
/// first to the last frame in which one is.
/// errors: markers x frames [m], NaN where it is not seen.
TextPieces FormatOsimMarkerErrors(const std::vector<std::string>& names,
                                  const Eigen::MatrixXd& errors, const PoseTrajectory& trajectory);

/// A trajectory as OpenSim's motion file (.mot, or .sto, which is the same): coordinates over time,
/// tab separated, as its inverse kinematics writes them: seconds, metres, degrees, y up.
///
/// Columns: time; the root's ROOT_tx, _ty, _tz: x, z, -y of its position in W; ROOT_rx, _ry, _rz:
/// roll, yaw, -pitch of its rotation in W, which with W's and the root's own axes turned to y up is
/// Ry(ry) Rz(rz) Rx(rx), 0 where the root stands as in the model file; then the joints under their
/// names. Blanks in names become '_'. The same ground as FormatTrc's. Postures must be finite. The
/// trajectory must outlive the text.
TextPieces FormatMot(const PoseTrajectory& trajectory, const std::string& root);

}  // namespace mmm_converter
