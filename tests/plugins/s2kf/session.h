// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/convert/marker_mapping.h"
#include "common/model/kinematic_model.h"
#include "common/model/subject.h"
#include "common/motion/marker_sequence.h"
#include "common/motion/pose_trajectory.h"

namespace mmm_converter::s2kf {

/// What a laboratory sees of a person whom the model does not know: the lengths of segments +-5 %,
/// markers 20 to 28 mm (rms per axis, drawn with the person) beside the model's places throughout.
struct Session {
  explicit Session(std::uint64_t seed);

  /// The person's markers: soft tissue of 4 mm (rms per axis) correlated over 0.3 s, 0.5 mm of
  /// white noise. Nothing hidden.
  MarkerSequence Record(const PoseTrajectory& motion) const;

  /// The model of the person as `calibrate` knows them from 40 s range of motion.
  KinematicModel Calibrate() const;

  std::uint64_t seed;
  KinematicModel model;   ///< scaled by height
  KinematicModel person;  ///< the truth
  std::vector<int> joints;
};

/// A tenth of the samples hidden, in blocks of 0.3 s.
MarkerSequence HideBlocks(const MarkerSequence& recording, std::uint64_t seed);

/// All markers of the right arm.
std::vector<std::string> RightArm();

enum class Limb { kArm, kLeg };

/// The limb's markers bear the other side's labels in frames [begin, end).
MarkerSequence SwapSides(MarkerSequence recording, Limb limb, int begin, int end);

}  // namespace mmm_converter::s2kf
