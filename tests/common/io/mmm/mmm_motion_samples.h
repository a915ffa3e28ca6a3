// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "common/io/mmm/mmm_motion.h"
#include "tests/support/shared_data.h"

namespace mmm_converter::testing {

inline std::string LegacyStandingFile() {
  return SharedData("mmm/motions_legacy/test_mmm_subject314_40joints_100Hz.xml");
}
inline std::string LegacyWalkingFile() {
  return SharedData("mmm/motions_legacy/walking_medium01_motion395.xml");
}
/// The same motion as LegacyWalkingFile, written by KIT's library, with the right leg's joints
/// changed.
inline std::string WalkingFile() {
  return SharedData(
      "mmm/motions_mmm2/output_from_walking_medium01_motion395_two_kinematic_sensors.xml");
}
inline std::string WavingFile() { return SharedData("mmm/motions_mmm2/wave_left01.xml"); }
inline std::string StirringFile() {
  return SharedData("mmm/kit_bimanual_10hz/Stir_files_motions_2941_Stir1_bc_s_right_03.xml");
}

inline MmmMotionOutput OutputOf(const MmmMotion& motion) {
  MmmMotionOutput output;
  output.motion_name = motion.name;
  output.model_path = motion.model_path;
  output.height = motion.size.height.value_or(1);
  output.mass = motion.size.mass.value_or(1);
  output.hand_length = motion.size.hand_length;
  output.trajectory = &motion.trajectory;
  output.markers = motion.markers.num_frames() > 0 ? &motion.markers : nullptr;
  return output;
}

}  // namespace mmm_converter::testing
