// SPDX-License-Identifier: MIT
#include "common/calibrate/calibration_frames.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/fit/posture_search.h"
#include "common/math/statistics.h"
#include "common/model/forward_kinematics.h"
#include "common/support/parallel.h"
#include "common/support/units.h"

namespace mmm_converter {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

constexpr double kInterval = 0.1;  // of candidate frames [s]
constexpr int kRounds = 5;
constexpr int kSearchAttempts = 4;
constexpr double kRobustDistance = 0.1;  // [m]
// A frame that fits this many times worse than the median one of its recording is not taken.
constexpr double kBadFactor = 2.5;

KinematicModel WithOffsets(const KinematicModel& model, const std::vector<MarkerIx>& markers,
                           const Matrix3Xd& offsets) {
  ModelDescription moved = DescriptionOf(model);
  for (std::size_t m = 0; m < markers.size(); ++m) {
    moved.markers[markers[m]].p_SM += offsets.col(static_cast<Eigen::Index>(m));
  }
  return KinematicModel(std::move(moved));
}

int CountSeen(const Matrix3Xd& z) {
  int seen = 0;
  for (Eigen::Index m = 0; m < z.cols(); ++m) seen += IsSeen(z.col(m));
  return seen;
}

/// take(m, r): marker m of a frame is r from its place, segment axes [m].
template <typename Take>
void ForEachResidual(const KinematicModel& model, const std::vector<int>& joints,
                     const std::vector<MarkerIx>& markers,
                     const std::vector<CalibrationFrame>& frames, Take take) {
  Posture full = ZeroPosture(model);
  for (const CalibrationFrame& frame : frames) {
    full.position = frame.posture.position;
    full.orientation = frame.posture.orientation;
    full.joint_angles(joints) = frame.posture.joint_angles;
    const auto X_WS = SegmentPoses(model, full);
    for (std::size_t m = 0; m < markers.size(); ++m) {
      const auto p_WM = frame.z.col(static_cast<Eigen::Index>(m));
      if (!IsSeen(p_WM)) continue;
      const ModelMarker& marker = model.markers()[markers[m]];
      take(m, Vector3d(X_WS[marker.segment].inverse() * p_WM - marker.p_SM));
    }
  }
}

/// By recording, the distance beyond which a frame of it is bad. Each has its own: one in which the
/// person stands fits better than any movement.
std::vector<double> BoundsOfRecordings(const std::vector<CalibrationFrame>& frames,
                                       const VectorXd& distance) {
  std::vector<std::vector<double>> distances(frames.empty() ? 0 : frames.back().recording + 1);
  for (std::size_t k = 0; k < frames.size(); ++k) {
    distances[frames[k].recording].push_back(distance[static_cast<Eigen::Index>(k)]);
  }
  std::vector<double> bounds(distances.size(), 0.0);
  for (std::size_t r = 0; r < bounds.size(); ++r) {
    if (!distances[r].empty()) bounds[r] = kBadFactor * Median(distances[r]);
  }
  return bounds;
}

VectorXd FitPostures(const MarkerKinematics& kinematics, const VectorXd& scale,
                     std::vector<CalibrationFrame>* frames,
                     const std::function<void()>& between_steps) {
  PostureFitOptions options;
  options.robust_distance = kRobustDistance;
  PostureSearch search(kinematics);
  VectorXd distance(frames->size());
  int assembled = -1;  // recording
  for (std::size_t k = 0; k < frames->size(); ++k) {
    if (between_steps) between_steps();
    CalibrationFrame& frame = (*frames)[k];
    PostureFit::Result fit;
    if (frame.posture.joint_angles.size() > 0) {
      fit = search.fit().Solve(frame.z, scale, options, &frame.posture);
    } else if (assembled != frame.recording) {
      fit = search.Assemble(frame.z, scale, options, kSearchAttempts, &frame.posture);
      assembled = frame.recording;
    } else {
      frame.posture = (*frames)[k - 1].posture;
      search.fit().Solve(frame.z, scale, options, &frame.posture);
      search.Improve(frame.z, scale, options, &frame.posture);
      fit = search.fit().Evaluate(frame.z, scale, options, frame.posture);
    }
    distance[static_cast<Eigen::Index>(k)] = fit.mean_distance;
  }
  return distance;
}

}  // namespace

std::vector<MarkerIx> UsedMarkers(const std::vector<CalibrationRecording>& recordings) {
  std::vector<MarkerIx> markers;
  for (const CalibrationRecording& recording : recordings) {
    for (const MarkerAssignment& assignment : recording.assignments) {
      markers.push_back(assignment.marker);
    }
  }
  std::sort(markers.begin(), markers.end());
  markers.erase(std::unique(markers.begin(), markers.end()), markers.end());
  return markers;
}

std::vector<CalibrationFrame> CandidateFrames(const std::vector<CalibrationRecording>& recordings,
                                              const std::vector<MarkerIx>& markers,
                                              int least_seen) {
  std::vector<CalibrationFrame> frames;
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    const MarkerSequence& sequence = *recordings[r].markers;
    const int stride = std::max(1, static_cast<int>(std::lround(kInterval * sequence.rate())));
    for (int k = 0; k < sequence.num_frames(); k += stride) {
      CalibrationFrame frame;
      frame.recording = static_cast<int>(r);
      frame.frame = k;
      frame.time = k / sequence.rate();
      frame.z.setConstant(3, static_cast<Eigen::Index>(markers.size()), kNaN);
      for (const MarkerAssignment& assignment : recordings[r].assignments) {
        const auto found = std::lower_bound(markers.begin(), markers.end(), assignment.marker);
        frame.z.col(found - markers.begin()) = sequence.frame(k).col(assignment.label);
      }
      if (CountSeen(frame.z) >= least_seen) frames.push_back(std::move(frame));
    }
  }
  return frames;
}

VectorXd FitPostures(const KinematicModel& model, const std::vector<int>& joints,
                     const std::vector<MarkerIx>& markers, std::vector<CalibrationFrame>* frames,
                     const std::function<void()>& between_steps) {
  const MarkerKinematics kinematics(model, joints, markers);
  return FitPostures(kinematics, VectorXd::Ones(kinematics.num_markers()), frames, between_steps);
}

void FitPosturesByPlaces(const KinematicModel& model, const std::vector<int>& joints,
                         const std::vector<MarkerIx>& markers, const VectorXd& noise_scale,
                         std::vector<CalibrationFrame>* frames,
                         const std::function<void()>& between_steps) {
  std::vector<CalibrationFrame> anew = *frames;
  for (CalibrationFrame& frame : anew) frame.posture = {};
  FitPostures(MarkerKinematics(model, joints, markers), noise_scale, &anew, between_steps);
  for (std::size_t k = 0; k < anew.size(); ++k) (*frames)[k].by_places = anew[k].posture;
}

Matrix3Xd MedianResiduals(const KinematicModel& model, const std::vector<int>& joints,
                          const std::vector<MarkerIx>& markers,
                          const std::vector<CalibrationFrame>& frames) {
  std::vector<std::vector<double>> residuals(3 * markers.size());
  ForEachResidual(model, joints, markers, frames, [&](std::size_t m, const Vector3d& r) {
    for (int i = 0; i < 3; ++i) residuals[3 * m + i].push_back(r[i]);
  });
  Matrix3Xd medians = Matrix3Xd::Zero(3, static_cast<Eigen::Index>(markers.size()));
  for (Eigen::Index i = 0; i < medians.size(); ++i) {
    if (!residuals[i].empty()) medians.reshaped()[i] = Median(residuals[i]);
  }
  return medians;
}

VectorXd SkinDeviations(const KinematicModel& model, const std::vector<int>& joints,
                        const std::vector<MarkerIx>& markers,
                        const std::vector<CalibrationFrame>& frames) {
  // Of a squared distance in three coordinates of variance 1 (chi-square).
  constexpr double kMedianSquare = 2.366;
  std::vector<std::vector<double>> squares(markers.size());
  double seen = 0;
  ForEachResidual(model, joints, markers, frames, [&](std::size_t m, const Vector3d& r) {
    squares[m].push_back(r.squaredNorm());
    ++seen;
  });
  const double coordinates = 3 * seen / static_cast<double>(frames.size());
  const double dofs = 6 + static_cast<double>(joints.size());
  const double left = std::max(1.0, coordinates - dofs) / coordinates;
  VectorXd deviations = VectorXd::Zero(static_cast<Eigen::Index>(markers.size()));
  for (std::size_t m = 0; m < markers.size(); ++m) {
    if (squares[m].empty()) continue;
    deviations[static_cast<Eigen::Index>(m)] = std::sqrt(Median(squares[m]) / kMedianSquare / left);
  }
  return deviations;
}

OffsetsInTurns FitOffsetsInTurns(const KinematicModel& model, const std::vector<int>& joints,
                                 const std::vector<MarkerIx>& markers,
                                 std::vector<CalibrationFrame>* frames,
                                 const std::function<void()>& between_steps) {
  OffsetsInTurns result;
  result.offsets.setZero(3, static_cast<Eigen::Index>(markers.size()));
  result.distance_before = FitPostures(model, joints, markers, frames, between_steps);
  for (int round = 0; round < kRounds; ++round) {
    result.offsets +=
        MedianResiduals(WithOffsets(model, markers, result.offsets), joints, markers, *frames);
    result.distance = FitPostures(WithOffsets(model, markers, result.offsets), joints, markers,
                                  frames, between_steps);
  }
  return result;
}

std::vector<CalibrationFrame> ChooseFrames(std::vector<CalibrationFrame> frames,
                                           const VectorXd& distance, int count) {
  const std::vector<double> bounds = BoundsOfRecordings(frames, distance);
  std::vector<CalibrationFrame> good;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const bool is_good = distance[static_cast<Eigen::Index>(k)] <= bounds[frames[k].recording];
    if (is_good) good.push_back(std::move(frames[k]));
  }
  if (static_cast<int>(good.size()) <= count) return good;
  std::vector<double> gap(good.size(), std::numeric_limits<double>::infinity());
  std::vector<CalibrationFrame> chosen;
  chosen.reserve(count);
  for (std::size_t next = 0; static_cast<int>(chosen.size()) < count;) {
    chosen.push_back(good[next]);
    for (std::size_t k = 0; k < good.size(); ++k) {
      const double to_next =
          (good[k].posture.joint_angles - chosen.back().posture.joint_angles).squaredNorm();
      gap[k] = std::min(gap[k], to_next);
    }
    next = static_cast<std::size_t>(std::max_element(gap.begin(), gap.end()) - gap.begin());
  }
  return chosen;
}

}  // namespace mmm_converter
