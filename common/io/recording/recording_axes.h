// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "common/io/recording/recording.h"
#include "common/motion/marker_sequence.h"

namespace mmm_converter {

struct UnitDecision {
  std::string unit = "mm";  ///< "mm", "cm", "m" or "in"
  double metres = 0.001;    ///< length of one unit
  bool guessed = false;
  std::string warning;  ///< empty: the file's unit is there and plausible
};

/// What markers (in file units) are measured in. said: by the file, may be empty or nonsense; it is
/// overruled only if a person (labels of a common marker set) would not be 0.5 m to 3 m in size
/// with it, and is with another one.
UnitDecision DecideUnit(const MarkerSequence& markers, const std::string& said);

/// @throws Error listing what is allowed.
UnitDecision ParseUnit(const std::string& text);

struct UpAxisDecision {
  UpAxis axis = UpAxis::kZ;
  bool decided = false;  ///< false: assumed
  std::string warning;
};

/// The axis that leads from feet to head, or between what else is known, over the whole trial.
/// Upside down for some time does not count: then the sign is the one with the steadier ground.
UpAxisDecision DecideUpAxis(const MarkerSequence& markers);

/// p = metres * RotationToZUp(axis) * p for all positions.
void ToMetresAndZUp(double metres, UpAxis axis, MarkerSequence* markers);

}  // namespace mmm_converter
