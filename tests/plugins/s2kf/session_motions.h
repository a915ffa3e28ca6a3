// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/model/kinematic_model.h"
#include "common/motion/pose_trajectory.h"

namespace mmm_converter::s2kf {

inline constexpr double kRangeShare = 0.7;  ///< of each joint, in a range-of-motion trial

struct NamedMotion {
  std::string name;
  PoseTrajectory motion;
};

/// Walking, a range-of-motion trial, a run ("quick motion"), waving and a cartwheel at 100 Hz, of
/// at most `frames` frames, in this order. All are made, with another seed others; only the
/// cartwheel is always the same.
std::vector<NamedMotion> SessionMotions(const KinematicModel& model, int frames,
                                        std::uint64_t seed);

/// The same with walking and the quick motion as they were recorded, low-passed.
/// @throws Error where ../shared is missing.
std::vector<NamedMotion> SessionMotionsWithRecordedOnes(const KinematicModel& model, int frames,
                                                        std::uint64_t seed);

}  // namespace mmm_converter::s2kf
