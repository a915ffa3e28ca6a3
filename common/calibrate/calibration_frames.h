// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "common/calibrate/calibration.h"
#include "common/model/kinematic_model.h"
#include "common/model/posture.h"

namespace mmm_converter {

/// One frame that a subject is calibrated on.
struct CalibrationFrame {
  int recording = 0;   ///< index
  int frame = 0;       ///< of the recording, counted from 0
  double time = 0;     ///< from the recording's first frame [s]
  Eigen::Matrix3Xd z;  ///< 3 x used markers [m]; NaN: not seen
  Posture posture;     ///< tracked joints
  Posture by_places;   ///< the same where the markers are where the model has them; may be empty
};

/// The used markers of all recordings, indices of the model, ascending.
std::vector<MarkerIx> UsedMarkers(const std::vector<CalibrationRecording>& recordings);

/// Frames about 0.1 s apart with at least `least_seen` used markers.
std::vector<CalibrationFrame> CandidateFrames(const std::vector<CalibrationRecording>& recordings,
                                              const std::vector<MarkerIx>& markers, int least_seen);

/// The frames' postures by least squares; returns each frame's mean distance over the markers seen
/// [m]. Those that have no posture yet start from the frame before. between_steps: of the options.
Eigen::VectorXd FitPostures(const KinematicModel& model, const std::vector<int>& joints,
                            const std::vector<MarkerIx>& markers,
                            std::vector<CalibrationFrame>* frames,
                            const std::function<void()>& between_steps = {});

/// Finds the frames' by_places. noise_scale: how well each place is known; the rest as FitPostures.
void FitPosturesByPlaces(const KinematicModel& model, const std::vector<int>& joints,
                         const std::vector<MarkerIx>& markers, const Eigen::VectorXd& noise_scale,
                         std::vector<CalibrationFrame>* frames,
                         const std::function<void()>& between_steps);

/// How far each marker is from where the model's segment has it, the median of the frames by axis,
/// 3 x markers [m], segment axes; 0 where it was not seen.
Eigen::Matrix3Xd MedianResiduals(const KinematicModel& model, const std::vector<int>& joints,
                                 const std::vector<MarkerIx>& markers,
                                 const std::vector<CalibrationFrame>& frames);

/// How far each coordinate of a marker is from where the model's segment has it, a standard
/// deviation, from the median of the frames, as wrong markers are among them [m]; 0 where it was
/// not seen. The postures have taken up what the best ones do in the mean.
Eigen::VectorXd SkinDeviations(const KinematicModel& model, const std::vector<int>& joints,
                               const std::vector<MarkerIx>& markers,
                               const std::vector<CalibrationFrame>& frames);

struct OffsetsInTurns {
  Eigen::Matrix3Xd offsets;         ///< of the markers, segment axes [m]
  Eigen::VectorXd distance_before;  ///< each frame's mean distance without them [m]
  Eigen::VectorXd distance;         ///< with them [m]
};

/// Postures and, in turns with them, one offset per marker: where the marker is in its segment in
/// the middle (median) frame. A start for FitBody that wrong markers do not disturb.
OffsetsInTurns FitOffsetsInTurns(const KinematicModel& model, const std::vector<int>& joints,
                                 const std::vector<MarkerIx>& markers,
                                 std::vector<CalibrationFrame>* frames,
                                 const std::function<void()>& between_steps);

/// At most `count` of the frames, each as far in joint angles from those chosen before as can be
/// (Gonzalez 1985), leaving out those that fit much worse than others of their
/// recording.
std::vector<CalibrationFrame> ChooseFrames(std::vector<CalibrationFrame> frames,
                                           const Eigen::VectorXd& distance, int count);

}  // namespace mmm_converter
