// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "common/convert/marker_mapping.h"
#include "common/model/kinematic_model.h"
#include "common/model/subject.h"
#include "common/motion/marker_sequence.h"
#include "common/support/warnings.h"

namespace mmm_converter {

class BodyKinematics;

/// A recording of the person, its labels assigned to markers of the model.
struct CalibrationRecording {
  std::string name;
  const MarkerSequence* markers = nullptr;
  std::vector<MarkerAssignment> assignments;
};

/// What is assumed of a person before a recording is seen, as standard deviations.
struct CalibrationOptions {
  int frames = 120;                ///< at most, chosen over all recordings
  double marker_deviation = 0.03;  ///< of a marker from the model's place, each coordinate [m]
  double side_correlation = 0;     ///< of markers at the same place of both sides
  double scale_deviation = 0.06;   ///< of a segment's scale
  double axis_deviation = 0.04;    ///< of a body's scale along an axis from its others' mean
  double side_deviation = 0.015;   ///< of left against right scale
  double height_deviation = 0;     ///< of all scales together, where the height is a guess
  double skin_deviation = 0.004;   ///< of a marker in its segment from frame to frame [m]
  double skin_time = 0.3;          ///< in which the skin moves on: nearer frames repeat it [s]
  bool may_stand = false;          ///< one posture is enough: the model's markers tell it
  /// A marker's place is known by marker_deviation times its noise scale, as landmarks are; else
  /// all are known alike, and noise scales are of the skin.
  bool places_by_noise = false;
  /// Of the mean over the frames of each angle from what known places alone tell [rad]; 0: they
  /// tell no more than each by itself.
  double mean_posture_deviation = 0;
  /// Is called often while it is computed; what it throws ends the estimate. May be empty.
  std::function<void()> between_steps = {};
};

/// A recording that has many markers elsewhere than the others: they were put on anew in between.
struct MovedMarkers {
  std::string recording;
  int moved = 0, markers = 0;
  double distance = 0;  ///< that is exceeded [m]
};

struct CalibrationResult {
  Subject subject;  ///< scales, offsets and sources; the caller knows name, height and mass
  double distance_before = 0;  ///< mean marker distance of the chosen frames' best postures [m]
  double distance_after = 0;   ///< the same for the subject's model [m]
  int frames = 0;
  int iterations = 0;
  double side_correlation = 0;  ///< that the offsets make likely
  bool stands = false;          ///< all the time: nothing tells where joints turn
  std::vector<MovedMarkers> moved;
};

/// Estimates postures, marker offsets and segment scales jointly over frames chosen for how much
/// they differ. joints: the tracked ones, indices of model, which is scaled by height. warnings:
/// what the recordings do not determine, and wrong markers.
/// @throws Error where the recordings are too short or too still to tell marker offsets from
///         posture; the message names what is missing.
CalibrationResult CalibrateSubject(const KinematicModel& model, const std::vector<int>& joints,
                                   const std::vector<CalibrationRecording>& recordings,
                                   const CalibrationOptions& options, Warnings* warnings = nullptr);

/// The same of a body whose sizes are its own; its markers are those of UsedMarkers. Leaves the
/// result in `kinematics`.
CalibrationResult CalibrateBody(BodyKinematics* kinematics,
                                const std::vector<CalibrationRecording>& recordings,
                                const CalibrationOptions& options, Warnings* warnings = nullptr);

}  // namespace mmm_converter
