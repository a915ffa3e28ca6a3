// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "common/contacts/contacts.h"

namespace mmm_converter {

/// What the ground exerts on one foot, in W: a column a frame.
struct FootWrench {
  Eigen::Matrix3Xd force;   ///< [N]
  Eigen::Matrix3Xd moment;  ///< about W's origin [N m]
  /// False: the foot pushes against what no plate measures, or measures of this foot alone.
  std::vector<bool> is_known;
};

/// The left foot's, then the right foot's.
using FootWrenches = std::array<FootWrench, 2>;

/// Frames of a motion.
struct FrameTimes {
  double rate = 0;        ///< [Hz]
  double first_time = 0;  ///< [s]
  int count = 0;
};

/// Of each frame the mean of the samples that are nearest to it, where plates bear one foot; then
/// low-passed as the motion is (LowPassed; 0: not). Within half a period of the cut-off of what is
/// not known, nothing is.
FootWrenches WrenchesOnFeet(const Contacts& contacts, const RecordedForces& forces,
                            const FrameTimes& times, double cutoff);

}  // namespace mmm_converter
