// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "common/motion/pose_trajectory.h"
#include "common/support/text_pieces.h"

namespace mmm_converter {

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
