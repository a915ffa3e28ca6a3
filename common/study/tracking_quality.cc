// SPDX-License-Identifier: MIT
#include "common/study/tracking_quality.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include "common/math/statistics.h"
#include "common/model/forward_kinematics.h"
#include "common/motion/marker_residuals.h"
#include "common/motion/marker_synthesis.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// A joint is on a limit where it is nearer to it than this share of its range.
constexpr double kNearLimit = 1e-3;

DistanceFigures MeasureDistances(const MatrixXd& distances) {
  const ResidualSummary summary = SummarizeResiduals(distances);
  const VectorXd frames = MeanOfEachFrame(distances);
  return {summary.mean, summary.p95, summary.max,
          Max({frames.data(), static_cast<std::size_t>(frames.size())})};
}

void JudgeFrames(const VectorXd& optimum, const MatrixXd& distances, TrackingQuality* quality) {
  const VectorXd means = MeanOfEachFrame(distances);
  for (int k = 0; k < means.size(); ++k) {
    if (!quality->first_good && IsGoodFrame(means[k], optimum[k])) quality->first_good = k;
    quality->lost_frames += IsLostFrame(means[k], optimum[k]) ? 1 : 0;
  }
}

// The compared joints' angles, joints x frames [rad]; an untracked joint rests.
MatrixXd ComparedAngles(const QualityReference& reference, const PoseTrajectory& trajectory) {
  MatrixXd angles(reference.joints.size(), trajectory.num_frames());
  for (int k = 0; k < trajectory.num_frames(); ++k) {
    const Posture posture = ModelPosture(*reference.model, trajectory, k);
    angles.col(k) = posture.joint_angles(reference.joints);
  }
  return angles;
}

void MeasureJoints(const QualityReference& reference, const PoseTrajectory& trajectory,
                   TrackingQuality* quality) {
  const MatrixXd angles = ComparedAngles(reference, trajectory);
  const auto frames = angles.cols();
  if (angles.size() == 0) return;
  if (frames > 1) {
    const MatrixXd steps = angles.rightCols(frames - 1) - angles.leftCols(frames - 1);
    quality->largest_step = steps.cwiseAbs().maxCoeff();
    if (frames > 2) {
      const MatrixXd accelerations = (steps.rightCols(frames - 2) - steps.leftCols(frames - 2)) *
                                     (trajectory.rate * trajectory.rate);
      quality->jitter = std::sqrt(accelerations.squaredNorm() / accelerations.size());
    }
  }
  double on_limit = 0;
  for (std::size_t j = 0; j < reference.joints.size(); ++j) {
    const Segment& joint = reference.model->joint(reference.joints[j]);
    if (HasNoLimits(joint)) continue;
    const double margin = kNearLimit * (joint.upper - joint.lower);
    const auto row = angles.row(static_cast<int>(j)).array();
    on_limit += (row <= joint.lower + margin || row >= joint.upper - margin).count();
  }
  quality->limit_share = on_limit / angles.size();
}

void MeasureTimes(const std::vector<FrameDiagnostic>& frames, TrackingQuality* quality) {
  std::vector<double> seconds;
  for (const FrameDiagnostic& frame : frames) {
    if (frame.seconds > 0) seconds.push_back(frame.seconds);
  }
  quality->median_seconds = Median(seconds);
  quality->p99_seconds = Percentile(seconds, 99);
}

void MeasureAgainstTruth(const QualityReference& reference, const PoseTrajectory& trajectory,
                         TrackingQuality* quality) {
  quality->joint_center_error = kNaN;
  quality->joint_angle_error = kNaN;
  if (reference.truth == nullptr || reference.joints.empty()) return;
  const KinematicModel& model = *reference.model;
  double centers = 0;
  double angles = 0;
  for (int k = 0; k < trajectory.num_frames(); ++k) {
    const Posture truth = ModelPosture(model, *reference.truth, k);
    const Posture posture = ModelPosture(model, trajectory, k);
    const auto X_true = SegmentPoses(model, truth);
    const auto X = SegmentPoses(model, posture);
    for (const int j : reference.joints) {
      const int segment = model.joint_segment(j);
      centers += (X_true[segment].translation() - X[segment].translation()).norm();
      angles += std::abs(truth.joint_angles[j] - posture.joint_angles[j]);
    }
  }
  const double count =
      static_cast<double>(trajectory.num_frames()) * static_cast<double>(reference.joints.size());
  quality->joint_center_error = centers / count;
  quality->joint_angle_error = angles / count;
}

void MeasureReliability(const QualityReference& reference, const PoseTrajectory& trajectory,
                        TrackingQuality* quality) {
  constexpr int kRootRows = 6;
  const MatrixXd& deviations = trajectory.standard_deviations;
  if (reference.truth == nullptr || deviations.cols() != trajectory.num_frames()) return;
  const KinematicModel& model = *reference.model;
  std::vector<std::pair<Eigen::Index, int>> compared;  // row of the deviations, joint of the model
  for (std::size_t i = 0; i < trajectory.joint_names.size(); ++i) {
    const int j = model.FindJoint(trajectory.joint_names[i]);
    if (std::find(reference.joints.begin(), reference.joints.end(), j) != reference.joints.end()) {
      compared.emplace_back(kRootRows + static_cast<Eigen::Index>(i), j);
    }
  }
  std::vector<double> within(kReliabilityMultiples.size(), 0);
  double count = 0;
  for (int k = 0; k < trajectory.num_frames(); ++k) {
    const Posture truth = ModelPosture(model, *reference.truth, k);
    const Posture posture = ModelPosture(model, trajectory, k);
    for (const auto& [row, j] : compared) {
      const double deviation = deviations(row, k);
      if (!std::isfinite(deviation)) continue;
      const double error = std::abs(truth.joint_angles[j] - posture.joint_angles[j]);
      ++count;
      for (std::size_t m = 0; m < within.size(); ++m) {
        within[m] += error <= kReliabilityMultiples[m] * deviation ? 1 : 0;
      }
    }
  }
  if (count == 0) return;
  for (double& share : within) share /= count;
  quality->reliability = std::move(within);
}

template <typename Get>
double MeanOf(const std::vector<TrackingQuality>& runs, Get get) {
  std::vector<double> values;
  values.reserve(runs.size());
  for (const TrackingQuality& run : runs) values.push_back(get(run));
  return Mean(values);
}

template <typename Get>
double MaxOf(const std::vector<TrackingQuality>& runs, Get get) {
  double max = kNaN;
  for (const TrackingQuality& run : runs) max = std::fmax(max, get(run));
  return max;
}

DistanceFigures SummarizeDistances(const std::vector<TrackingQuality>& runs,
                                   DistanceFigures TrackingQuality::*part) {
  return {MeanOf(runs, [&](const TrackingQuality& q) { return (q.*part).mean; }),
          MeanOf(runs, [&](const TrackingQuality& q) { return (q.*part).p95; }),
          MaxOf(runs, [&](const TrackingQuality& q) { return (q.*part).max; }),
          MaxOf(runs, [&](const TrackingQuality& q) { return (q.*part).worst_frame; })};
}

}  // namespace

double NormalShareWithin(double multiple) { return std::erf(multiple / std::numbers::sqrt2); }

double TrackingQuality::ReliabilityAt(double multiple) const {
  const auto found =
      std::find(kReliabilityMultiples.begin(), kReliabilityMultiples.end(), multiple);
  if (reliability.empty() || found == kReliabilityMultiples.end()) return kNaN;
  return reliability[static_cast<std::size_t>(found - kReliabilityMultiples.begin())];
}

bool IsGoodFrame(double distance, double optimum) { return distance <= 1.2 * optimum + 0.002; }
bool IsLostFrame(double distance, double optimum) { return distance > 2 * optimum + 0.020; }

TrackingQuality MeasureQuality(const QualityReference& reference, const MatrixXd& distances,
                               const PoseTrajectory& trajectory,
                               const std::vector<FrameDiagnostic>& frames) {
  TrackingQuality quality;
  quality.all = MeasureDistances(distances);
  quality.hidden = MeasureDistances(reference.hidden.select(
      distances, MatrixXd::Constant(distances.rows(), distances.cols(), kNaN)));
  JudgeFrames(reference.optimum, distances, &quality);
  MeasureJoints(reference, trajectory, &quality);
  MeasureTimes(frames, &quality);
  MeasureAgainstTruth(reference, trajectory, &quality);
  MeasureReliability(reference, trajectory, &quality);
  return quality;
}

TrackingQuality Summarize(const std::vector<TrackingQuality>& runs) {
  using Quality = TrackingQuality;
  Quality all;
  all.all = SummarizeDistances(runs, &Quality::all);
  all.hidden = SummarizeDistances(runs, &Quality::hidden);
  const bool have_all = std::all_of(runs.begin(), runs.end(),
                                    [](const Quality& q) { return q.first_good.has_value(); });
  if (have_all && !runs.empty()) {
    all.first_good = MeanOf(runs, [](const Quality& q) { return *q.first_good; });
  }
  all.lost_frames = MeanOf(runs, [](const Quality& q) { return q.lost_frames; });
  all.jitter = MeanOf(runs, [](const Quality& q) { return q.jitter; });
  all.largest_step = MaxOf(runs, [](const Quality& q) { return q.largest_step; });
  all.limit_share = MeanOf(runs, [](const Quality& q) { return q.limit_share; });
  all.median_seconds = MeanOf(runs, [](const Quality& q) { return q.median_seconds; });
  all.p99_seconds = MeanOf(runs, [](const Quality& q) { return q.p99_seconds; });
  all.joint_center_error = MeanOf(runs, [](const Quality& q) { return q.joint_center_error; });
  all.joint_angle_error = MeanOf(runs, [](const Quality& q) { return q.joint_angle_error; });
  const bool all_reliable = std::all_of(runs.begin(), runs.end(),
                                        [](const Quality& q) { return !q.reliability.empty(); });
  if (!all_reliable || runs.empty()) return all;
  for (std::size_t m = 0; m < kReliabilityMultiples.size(); ++m) {
    all.reliability.push_back(MeanOf(runs, [&](const Quality& q) { return q.reliability[m]; }));
  }
  return all;
}

}  // namespace mmm_converter
