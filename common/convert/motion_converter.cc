// SPDX-License-Identifier: MIT
#include "common/convert/motion_converter.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "common/model/forward_kinematics.h"
#include "common/support/error.h"

namespace mmm_converter {
namespace {

constexpr int kFewestMarkers = 3;

// An incident goes on where it stops for no longer than this [s].
constexpr double kBridgedTime = 0.1;

int CountSeen(const MarkerSequence& recording, const std::vector<MarkerAssignment>& assignments,
              int frame) {
  const auto points = recording.frame(frame);
  return static_cast<int>(std::count_if(
      assignments.begin(), assignments.end(),
      [&](const MarkerAssignment& assignment) { return IsSeen(points.col(assignment.label)); }));
}

// The first frame in which a posture can be assembled. A person is there from the start, objects
// are fetched.
int FindFirstFrame(const MarkerSequence& recording, const KinematicModel& model,
                   const std::vector<MarkerAssignment>& assignments) {
  const bool is_object = model.num_joints() == 0;
  const int last = is_object
                       ? recording.num_frames()
                       : static_cast<int>(std::min<double>(
                             recording.num_frames(), std::max(1.0, std::ceil(recording.rate()))));
  int most = 0;
  for (int k = 0; k < last; ++k) {
    const int seen = CountSeen(recording, assignments, k);
    if (seen >= kFewestMarkers) return k;
    most = std::max(most, seen);
  }
  throw Error(
      fmt::format("no frame{} shows {} mapped markers (at most {} of {} are seen); check the "
                  "marker mapping{}",
                  is_object ? "" : " of the first second", kFewestMarkers, most, assignments.size(),
                  is_object ? "" : ", or start at a later frame"),
      is_object ? Remedy::kNone : Remedy::kFrames);
}

// Fills one frame of a result from what a converter says of it.
class ResultWriter {
 public:
  ResultWriter(const MarkerSequence& recording, const KinematicModel& model,
               const std::vector<MarkerAssignment>& assignments, const std::vector<int>& joints)
      : recording_(recording), model_(model), assignments_(assignments), joints_(joints) {
    const int frames = recording.num_frames();
    PoseTrajectory& trajectory = result_.trajectory;
    trajectory.rate = recording.rate();
    trajectory.first_time = recording.first_time();
    for (const int joint : joints) trajectory.joint_names.push_back(model.joint(joint).name);
    trajectory.postures.resize(frames);
    trajectory.standard_deviations.setConstant(6 + static_cast<int>(joints.size()), frames,
                                               std::numeric_limits<double>::quiet_NaN());
    result_.residuals.setConstant(static_cast<int>(assignments.size()), frames,
                                  std::numeric_limits<double>::quiet_NaN());
    result_.frames.resize(frames);
    verdicts_.setConstant(static_cast<int>(assignments.size()), frames, kAsLabelled);
  }

  void WritePosture(int k, const FrameEstimate& estimate) {
    Posture& posture = result_.trajectory.postures[k];
    posture.position = estimate.posture.position;
    posture.orientation = estimate.posture.orientation;
    posture.joint_angles = estimate.posture.joint_angles(joints_);
    if (estimate.standard_deviations.size() > 0) {
      auto deviations = result_.trajectory.standard_deviations.col(k);
      deviations.head<6>() = estimate.standard_deviations.head<6>();
      const auto of_joints =
          estimate.standard_deviations.tail(estimate.standard_deviations.size() - 6);
      deviations.tail(static_cast<int>(joints_.size())) = of_joints(joints_);
    }
  }

  void Write(int k, const FrameEstimate& estimate, double seconds) {
    WritePosture(k, estimate);
    result_.residuals.col(k) = estimate.residuals;
    result_.frames[k] = {estimate.markers_seen,
                         estimate.markers_downweighted,
                         estimate.markers_wrong,
                         estimate.nis,
                         estimate.reassembled,
                         estimate.converged,
                         seconds};
    if (estimate.verdicts.size() > 0) verdicts_.col(k) = estimate.verdicts;
  }

  // Frames with too few markers to assemble take the first assembled posture.
  void WriteEarlier(int first, const FrameEstimate& estimate) {
    const Eigen::Matrix3Xd p_WM = MarkerPositions(model_, estimate.posture);
    for (int k = 0; k < first; ++k) {
      WritePosture(k, estimate);
      result_.frames[k].markers_seen = CountSeen(recording_, assignments_, k);
      const auto points = recording_.frame(k);
      for (std::size_t i = 0; i < assignments_.size(); ++i) {
        const MarkerAssignment& assignment = assignments_[i];
        result_.residuals(static_cast<int>(i), k) =
            (points.col(assignment.label) - p_WM.col(assignment.marker)).norm();
      }
    }
  }

  ConversionResult Finish() {
    const int bridged = static_cast<int>(std::lround(kBridgedTime * recording_.rate()));
    result_.incidents = FindIncidents(verdicts_, bridged);
    return std::move(result_);
  }

 private:
  const MarkerSequence& recording_;
  const KinematicModel& model_;
  const std::vector<MarkerAssignment>& assignments_;
  const std::vector<int>& joints_;
  Eigen::MatrixXi verdicts_;  // assignments x frames
  ConversionResult result_;
};

}  // namespace

MotionConverter::~MotionConverter() = default;
MotionConverterFactory::~MotionConverterFactory() = default;

ConversionResult MotionConverter::Convert(const MarkerSequence& recording,
                                          const KinematicModel& model,
                                          const std::vector<MarkerAssignment>& assignments,
                                          const std::function<bool(int)>& progress) {
  using Clock = std::chrono::steady_clock;
  const int first = FindFirstFrame(recording, model, assignments);
  const int frames = recording.num_frames();
  const double dt = 1 / recording.rate();
  ResultWriter writer(recording, model, assignments, joints());
  for (int k = first; k < frames; ++k) {
    const Clock::time_point start = Clock::now();
    const FrameEstimate& estimate =
        k == first ? Assemble(recording.frame(k)) : Track(recording.frame(k), dt);
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    writer.Write(k, estimate, seconds);
    if (k == first) writer.WriteEarlier(first, estimate);
    if (progress && !progress(k + 1)) {
      throw Error(fmt::format("cancelled after {} of {} frames", k + 1, frames));
    }
  }
  return writer.Finish();
}

}  // namespace mmm_converter
