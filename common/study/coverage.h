// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "common/convert/tracking_setup.h"
#include "common/motion/anatomical_angles.h"
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

/// An end of the body, which markers elsewhere do not tell: "pelvis", "left foot", "right hand".
struct EndPart {
  std::string name;
  int fewest = 1;               ///< markers that tell it
  std::vector<LabelIx> labels;  ///< of the assigned markers on it

  bool IsKnownBy(int markers) const { return markers >= fewest; }
};

/// Those that a person of MMM or OpenSim has; none of another model.
std::vector<EndPart> EndPartsOf(const TrackingSetup& setup);

/// The frames in which all of these limbs and end parts are known, but for a tenth of a second;
/// what the model does not have is left out. A limb with fewer markers than tell it is known where
/// all are seen, a pelvis with one marker always; what has none is never known.
std::vector<bool> KnownFrames(const TrackingSetup& setup, const std::vector<std::string>& parts,
                              const MarkerSequence& recording);

/// Limbs that no or too few markers show, and joints that none does: they are at rest, or drawn
/// along. Empty: all are shown.
std::string DescribeUnshown(const TrackingSetup& setup);

/// The angles of a motion that is tracked so, without those that no assigned marker tells.
AnatomicalAngles ShownAngles(const TrackingSetup& setup, const PoseTrajectory& motion);

/// NaN where what an angle lies between is not known. The angles' last frame is the recording's.
void HideUnknown(const TrackingSetup& setup, const MarkerSequence& recording,
                 AnatomicalAngles* angles);

/// Which markers show what of a body.
struct Coverage {
  int num_markers = 0;  ///< that are assigned
  std::vector<Limb> limbs;
  std::vector<EndPart> ends;
};

Coverage MeasureCoverage(const TrackingSetup& setup);

struct Gap {
  std::string what;  ///< a limb, or "the body"
  int first_frame = 0;
  int last_frame = 0;
  double seconds = 0;
};

/// The three longest times of half a second in which no marker is seen, and the longest of a second
/// in which a limb or a hand, of half a second in which the pelvis or a foot has fewer than it is
/// known by; what has fewer at all times, or is hidden hardly longer than what it is a part of, is
/// left out.
std::vector<Gap> LongGaps(const TrackingSetup& setup, const MarkerSequence& recording);

}  // namespace mmm_converter
