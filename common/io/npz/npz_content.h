// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "common/motion/recording_content.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// Whether it is a .npz file with arrays of a person's motion, as far as their names tell.
bool HoldsMotion(const std::string& file);

/// A motion of SMPL, SMPL-H or SMPL-X; the joints of the body alone are read. Names are those of
/// AMASS; other programs' are known, too.
///   poses: frames x 66 or more: rotation vectors, or matrices (frames, joints, 3, 3); of SMPL-X
///     where there are 165. Or root_orient and pose_body, of SMPL-X where surface_model_type does
///     not say otherwise.
///   trans [m]; smpl_scaling is its unit. betas: of options.smpl_model, which tells where the
///     joints are at the zero pose. Without it StandInSmplModel.
///   mocap_framerate, mocap_frame_rate, fps, ...; else mocap_time_length tells the rate.
/// Or places of joints (global_joint_positions: frames x joints x 3), as in a .npy file.
/// @throws Error as NpzFile, and where there is no such motion.
RecordingContent ReadNpzContent(const std::string& file, const ContentOptions& options,
                                Warnings* warnings);

/// Places of joints of SMPL's body or of LAFAN1's: frames x joints x 3; or a motion of Motion-X's:
/// frames x 322.
/// @throws Error
RecordingContent ReadNpyContent(const std::string& file, const ContentOptions& options,
                                Warnings* warnings);

}  // namespace mmm_converter
