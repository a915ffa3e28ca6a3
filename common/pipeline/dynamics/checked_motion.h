// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "common/io/mmm/mmm_motion.h"
#include "common/model/kinematic_model.h"
#include "common/motion/pose_trajectory.h"
#include "common/pipeline/conversion.h"
#include "common/pipeline/input/input.h"
#include "common/pipeline/input/person.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// A finished motion with the model of its person.
struct CheckedMotion {
  std::string file;
  std::string name;        ///< of the motion
  int first_frame = 0;     ///< that is checked, counted from 0 in the file; see begin
  std::string model_file;  ///< reference model
  Person person;
  KinematicModel model;  ///< of the person
  /// All numbers finite; with the frames before and behind those that are checked, as far as they
  /// are known.
  PoseTrajectory trajectory;
  Warnings warnings;
  int begin = 0;  ///< of trajectory: frames [begin, end) are checked
  int end = 0;
  std::string forces_file = {};  ///< of the ground, beside it; empty: none
};

/// Reads the motion request.file, the only one or request.reading.motion. Its model is the
/// request's, else the one that the file names, where it is there, else the shipped one; the person
/// as for recordings, but nobody's height is estimated.
/// @throws Error
CheckedMotion ReadCheckedMotion(const InputRequest& request);

/// The same of a motion that was read; request.file names it, and the folder of its model.
CheckedMotion CheckedMotionOf(MmmMotion motion, const InputRequest& request);

/// The same of what was converted, with its model and person.
CheckedMotion CheckedMotionOf(const ConversionReport& conversion, const InputRequest& request);

}  // namespace mmm_converter
