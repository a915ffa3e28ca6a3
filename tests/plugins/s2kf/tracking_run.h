// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "common/convert/marker_mapping.h"
#include "common/model/kinematic_model.h"
#include "common/motion/marker_sequence.h"
#include "common/motion/pose_trajectory.h"
#include "plugins/s2kf/s2kf_settings.h"
#include "tests/support/synthetic_person.h"

namespace mmm_converter::s2kf {

using testing::AssignAll;
using testing::ScaledReferenceModel;
using testing::SetupOf;

/// Indices of KIT's 44 joints, or of the 40 of the paper.
std::vector<int> MotionJoints(const KinematicModel& model, int count);

/// A recorded motion made smooth: joint angles and root low-passed at 6 Hz (Gaussian), as joint
/// angles that were fitted frame by frame jump.
PoseTrajectory LowPassed(const PoseTrajectory& motion);

/// The same postures in the settings of the paper [S15], as in
/// xml_config/converters/s2kf_paper.xml.
S2kfSettings PaperSettings();

/// What a tracker did, frame by frame, measured against all markers (hidden ones too).
struct TrackedRun {
  std::vector<double> distance;  ///< mean over markers [m]
  std::vector<double> optimum;   ///< the same at the frame's least-squares optimum [m]
  double joint_error = 0;        ///< mean |angle - truth| [rad], with truth
  double centre_error = 0;       ///< mean distance of joint centres [m], with truth
  double optimum_joint_error = 0;
  double optimum_centre_error = 0;
  int lost = 0;  ///< frames that were not converged although three markers were seen
  bool inside_limits = true;
  double largest_step = 0;  ///< of a joint within a frame [rad]

  double MeanDistance(int begin, int end) const;
  double MeanOptimum(int begin, int end) const;
  double Worst() const;
  /// Within 10 % + 1 mm of the frame's optimum.
  bool IsGood(int frame) const { return distance[frame] <= 1.1 * optimum[frame] + 0.001; }
  /// Number of bad frames in [begin, end).
  int BadFrames(int begin, int end) const;
};

/// seen: what the converter gets; all: the same frames with every marker. truth: nullptr, or the
/// motion that the markers were made from.
TrackedRun RunTracker(const KinematicModel& model, const std::vector<int>& joints,
                      const S2kfSettings& settings, const MarkerSequence& seen,
                      const MarkerSequence& all, const PoseTrajectory* truth,
                      const std::vector<MarkerAssignment>& assignments);

}  // namespace mmm_converter::s2kf
