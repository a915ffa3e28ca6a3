// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "common/angles/anatomical_angles.h"
#include "common/convert/tracking_setup.h"
#include "common/motion/marker_sequence.h"
#include "common/motion/pose_trajectory.h"

namespace mmm_converter {

/// A limb of a person (LimbOfJoint), and by which markers its joints are known.
struct Limb {
  std::string name;
  int num_joints = 0;
  int free_joints = 0;          ///< that move no assigned marker: their angles are not known
  std::vector<LabelIx> labels;  ///< of the assigned markers that its joints move

  /// Whether so many markers may tell the angles of all joints.
  bool IsKnownBy(int markers) const { return 3 * markers >= num_joints; }
};

/// Those with tracked joints; none of a model that is not MMM's.
std::vector<Limb> LimbsOf(const TrackingSetup& setup);

/// Limbs that no or too few markers show, and joints that none does: they are at rest, or drawn
/// along. Empty: all are shown.
std::string DescribeUnshown(const std::vector<Limb>& limbs);

/// The angles of a motion that is tracked so, without those that no assigned marker tells.
AnatomicalAngles ShownAngles(const TrackingSetup& setup, const PoseTrajectory& motion);

struct Gap {
  std::string what;  ///< a limb, or "the body"
  int first_frame = 0;
  int last_frame = 0;
  double seconds = 0;
};

/// limbs: LimbsOf(setup). The three longest times of half a second in which no marker is seen, and
/// the longest of a second in which a limb has fewer than it is known by; limbs that have fewer at
/// all times, or are hidden hardly longer than the whole body, are left out.
std::vector<Gap> LongGaps(const TrackingSetup& setup, const std::vector<Limb>& limbs,
                          const MarkerSequence& recording);

}  // namespace mmm_converter
