// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "common/io/recording/recording.h"
#include "common/motion/marker_sequence.h"

namespace mmm_converter {

struct UnitDecision {
  std::string unit = "mm";  ///< "mm", "cm", "m" or "in"
  double metres = 0.001;    ///< length of one unit
  bool guessed = false;
  std::string warning;       ///< empty: the file's unit is there and plausible
  bool is_doubtful = false;  ///< the file says something else, or no unit is plausible
};

/// What markers (in file units) are measured in. said: by the file, may be empty or nonsense; it is
/// overruled only if a person (labels of a common marker set) would not be 0.5 m to 3 m in size
/// with it, and is with another one.
UnitDecision DecideUnit(const MarkerSequence& markers, const std::string& said);

/// @throws Error listing what is allowed.
UnitDecision ParseUnit(const std::string& text);

struct UpAxisDecision {
  UpAxis axis = UpAxis::kZ;
  bool decided = false;     ///< from the markers; false: stated by the file, or assumed
  std::string warning;      ///< empty: nothing contradicts it
  bool is_doubtful = true;  ///< where there is a warning; false: what contradicts it can't be right
};

/// What is said of a recording's up axis.
struct UpAxisClaims {
  std::optional<UpAxis> given = {};   ///< by the user
  std::optional<UpAxis> stated = {};  ///< by the file
  std::vector<UpAxis> usual = {};     ///< in files of the format
};

/// What the user says, or else what the file states, or else the axis along which the person of the
/// markers stands: that which leads from feet to head, or between what else is known, over the
/// whole trial. Upside down for some time does not count: then the sign is the one with the
/// steadier ground. Where these, or the usual axes, disagree there is a warning, and the ground
/// counts, the lowest markers being near 0 throughout: a file without ground is overruled where the
/// person would be upside down, or would travel up and down by more than a metre and stands on the
/// ground of another axis; and a person lies on the ground of a usual axis rather than stands
/// without any. Where the person is bent, the first usual axis that has a ground is up, or else the
/// first one. markers: in file units of so many metres.
UpAxisDecision DecideUpAxis(const MarkerSequence& markers, double metres,
                            const UpAxisClaims& claims);

/// p = metres * RotationToZUp(axis) * p for all positions.
void ToMetresAndZUp(double metres, UpAxis axis, MarkerSequence* markers);

}  // namespace mmm_converter
