// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "common/convert/tracking_setup.h"
#include "common/model/subject.h"
#include "common/motion/marker_sequence.h"
#include "common/motion/pose_trajectory.h"

namespace mmm_converter::testing {

/// The project's reference model scaled to a height [m] and 70 kg.
KinematicModel ScaledReferenceModel(double height);

/// KIT's 44 joints, indices of the model.
std::vector<int> TrackedJoints(const KinematicModel& model);

/// A person other than the model: every length off by up to 5 %, the same left and right; every
/// marker off by `marker_deviation` (rms per axis) [m], of which one half of the variance mirrored
/// left and right, as one hand puts them on.
Subject DrawPerson(const KinematicModel& model, std::uint64_t seed,
                   double marker_deviation = 0.028);

/// A range-of-motion trial at 100 Hz: every joint swings through the middle `share` of its range,
/// each at a frequency of its own between 0.15 and 0.5 Hz, while the person turns slowly.
PoseTrajectory RangeOfMotion(const KinematicModel& model, double seconds, double share,
                             std::uint64_t seed);

/// The markers of a person in motion: soft tissue moves by 4 mm, noise is 0.1 mm.
MarkerSequence RecordPerson(const KinematicModel& person, const PoseTrajectory& motion,
                            std::uint64_t seed);

/// Labels are marker names without MARKER_, all mapped.
std::vector<MarkerAssignment> AssignAll(const KinematicModel& model,
                                        const MarkerSequence& recording);

/// A setup of these.
TrackingSetup SetupOf(const KinematicModel& model, std::vector<int> joints,
                      std::vector<MarkerAssignment> assignments);

/// Mean distance of the tracked joints' centres over all frames [m]; trajectories by joint name.
double MeanCentreError(const KinematicModel& person, const PoseTrajectory& truth,
                       const KinematicModel& model, const PoseTrajectory& estimate);

/// The least-squares postures of a recording.
PoseTrajectory FitRecording(const KinematicModel& model, const std::vector<int>& joints,
                            const std::vector<MarkerAssignment>& assignments,
                            const MarkerSequence& recording);

/// Mean marker distance of these [m].
double MeanDistance(const KinematicModel& model, const std::vector<MarkerAssignment>& assignments,
                    const MarkerSequence& recording, const PoseTrajectory& estimate);

}  // namespace mmm_converter::testing
