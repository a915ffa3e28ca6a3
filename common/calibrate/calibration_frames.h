// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/calibrate/calibration.h"
#include "common/model/kinematic_model.h"
#include "common/model/posture.h"

namespace mmm_converter {

/// One frame that a subject is calibrated on.
struct CalibrationFrame {
  int recording = 0;   ///< index
  int frame = 0;       ///< of the recording, counted from 0
  Eigen::Matrix3Xd z;  ///< 3 x used markers [m]; NaN: not seen
  Posture posture;     ///< tracked joints
};

/// The used markers of all recordings, indices of the model, ascending.
std::vector<int> UsedMarkers(const std::vector<CalibrationRecording>& recordings);

/// Frames about 0.1 s apart with at least `least_seen` used markers.
std::vector<CalibrationFrame> CandidateFrames(const std::vector<CalibrationRecording>& recordings,
                                              const std::vector<int>& markers, int least_seen);

/// Fits the frames' postures and, in turns with them, one offset per marker: where the marker is in
/// its segment in the middle (median) frame. Returns the offsets, 3 x markers [m], segment axes.
/// distance: mean over seen markers per frame at the end [m].
Eigen::Matrix3Xd FitOffsetsInTurns(const KinematicModel& model, const std::vector<int>& joints,
                                   const std::vector<int>& markers,
                                   std::vector<CalibrationFrame>* frames,
                                   Eigen::VectorXd* distance_before, Eigen::VectorXd* distance);

/// At most `count` of the frames, each as far in joint angles from those chosen before as can be
/// (Gonzalez 1985), leaving out those that fit much worse than the others.
std::vector<CalibrationFrame> ChooseFrames(std::vector<CalibrationFrame> frames,
                                           const Eigen::VectorXd& distance, int count);

}  // namespace mmm_converter
