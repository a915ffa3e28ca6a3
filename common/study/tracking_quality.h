// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "common/convert/motion_converter.h"
#include "common/model/kinematic_model.h"
#include "common/motion/hiding.h"
#include "common/motion/pose_trajectory.h"

namespace mmm_converter {

/// Distances between measured and model markers [m]; NaN where there is none.
struct DistanceFigures {
  double mean = 0;         ///< over all markers and frames
  double p95 = 0;          ///< 95th percentile of the same
  double max = 0;          ///< of the same
  double worst_frame = 0;  ///< largest mean over the markers of a frame
};

/// Multiples of a standard deviation at which reliability is measured.
inline constexpr std::array kReliabilityMultiples = {0.25, 0.5, 0.75, 1.0, 1.25, 1.5,
                                                     1.75, 2.0, 2.25, 2.5, 3.0};

/// Share of normal deviates that are within so many standard deviations.
double NormalShareWithin(double multiple);

/// How well a motion was tracked. Figures of joints are over those that are compared.
struct TrackingQuality {
  DistanceFigures all;               ///< over every measured marker, hidden ones too
  DistanceFigures hidden;            ///< over markers that were hidden from the converter
  std::optional<double> first_good;  ///< frames to converge: the first frame that is good
  double lost_frames = 0;
  double jitter = 0;              ///< rms joint acceleration (second differences) [rad/s^2]
  double largest_step = 0;        ///< of a joint within a frame [rad]
  double limit_share = 0;         ///< of joint samples that are on a limit
  double median_seconds = 0;      ///< time a frame
  double p99_seconds = 0;         ///< 99th percentile of the same
  double joint_center_error = 0;  ///< mean distance of joint centres [m]; NaN without truth
  double joint_angle_error = 0;   ///< mean |angle - truth| [rad]; NaN without truth
  /// Share of the joint angles within each of kReliabilityMultiples of their own deviations from
  /// the truth; empty where these or the truth are not known.
  std::vector<double> reliability;

  /// One of these; NaN where there is none. multiple: of kReliabilityMultiples.
  double ReliabilityAt(double multiple) const;
};

// A frame is judged by its mean marker distance d beside that of its least-squares optimum o
// (`optimal_fit.h`), so that neither depends on who else is compared.

/// d <= 1.2 o + 2 mm.
bool IsGoodFrame(double distance, double optimum);
/// d > 2 o + 20 mm.
bool IsLostFrame(double distance, double optimum);

/// What a result is measured against. Pointers must outlive the call.
struct QualityReference {
  const KinematicModel* model = nullptr;
  std::vector<int> joints;  ///< that are compared, indices of the model
  /// Markers x frames: true where the marker was hidden from the converter.
  HiddenMarkers hidden;
  Eigen::VectorXd optimum;                ///< per frame, least mean distance [m]
  const PoseTrajectory* truth = nullptr;  ///< nullptr: not known
};

/// distances: markers x frames [m], hidden markers too; NaN: not measured. trajectory: of the
/// reference's model. frames: the converter's diagnostics, for the times; may be empty.
TrackingQuality MeasureQuality(const QualityReference& reference, const Eigen::MatrixXd& distances,
                               const PoseTrajectory& trajectory,
                               const std::vector<FrameDiagnostic>& frames);

/// Of several runs: means of means, percentiles and counts; the largest of max, worst_frame and
/// largest_step; first_good only where all runs have one.
TrackingQuality Summarize(const std::vector<TrackingQuality>& runs);

}  // namespace mmm_converter
