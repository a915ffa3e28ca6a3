// SPDX-License-Identifier: MIT
#include "common/pipeline/input/trunk_axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "common/fit/height_estimate.h"
#include "common/fit/posture_search.h"
#include "common/io/recording/recording_axes.h"
#include "common/model/coordinate_map.h"
#include "common/model/model_scaling.h"
#include "common/study/coverage.h"

namespace mmm_converter {
namespace {

using Eigen::Vector3d;

constexpr int kFrames = 12;
constexpr int kAttempts = 8;
constexpr int kFewestOfTrunk = 3;      // labels that determine how it lies
constexpr double kUprightTrunk = 0.5;  // cosine of 60 degrees
constexpr double kNobodysMass = 70;

/// Labels that no arm or leg moves.
int LabelsOfTrunk(const TrackingSetup& setup) {
  const std::vector<Limb> limbs = LimbsOf(setup);
  return static_cast<int>(
      std::count_if(setup.assignments().begin(), setup.assignments().end(), [&](const auto& one) {
        return std::none_of(limbs.begin(), limbs.end(), [&](const Limb& limb) {
          const bool is_limb = limb.name.ends_with("arm") || limb.name.ends_with("leg");
          return is_limb && std::count(limb.labels.begin(), limb.labels.end(), one.label) > 0;
        });
      }));
}

/// The frames that show most labels, one of each twelfth.
std::vector<Eigen::Matrix3Xd> ChooseFrames(const std::vector<LabelIx>& labels,
                                           const MarkerSequence& markers) {
  std::vector<Eigen::Matrix3Xd> frames;
  const long all = markers.num_frames();
  for (int part = 0; part < kFrames; ++part) {
    Eigen::Matrix3Xd best;
    Eigen::Index most = kFewestMarkers - 1;
    for (long k = all * part / kFrames; k < all * (part + 1) / kFrames; ++k) {
      const Eigen::Matrix3Xd z = markers.frame(static_cast<int>(k))(Eigen::all, labels);
      const Eigen::Index seen = z.row(0).array().isFinite().count();
      if (seen <= most) continue;
      most = seen;
      best = z;
    }
    if (best.size() > 0) frames.push_back(std::move(best));
  }
  return frames;
}

/// Where the root's upward direction points, by frame.
std::vector<Vector3d> UpOfTrunk(const TrackingSetup& setup, const Input& input) {
  const std::vector<MarkerIx> markers = MarkerIndices(setup.assignments());
  const std::vector<LabelIx> labels = LabelIndices(setup.assignments());
  const MarkerSequence& recording = input.recording.markers;
  const auto frames = ChooseFrames(labels, recording);
  if (frames.empty()) return {};
  Eigen::VectorXd scales(static_cast<Eigen::Index>(markers.size()));
  for (std::size_t i = 0; i < markers.size(); ++i) {
    scales[static_cast<Eigen::Index>(i)] = setup.assignments()[i].noise_scale;
  }
  KinematicModel model = *setup.model;
  if (input.model->is_reference) {
    HeightOptions options;
    options.noise_scale = scales;
    options.with_ordinary_height = true;
    const double height =
        EstimateHeight(*setup.model, setup.joints, markers, labels, recording, options).height;
    model = ScaleWinter(*setup.model, {height, kNobodysMass, {}});
  }
  Vector3d up_S = Vector3d::UnitZ();
  if (model.coordinates()) up_S = RestPosture(model).orientation.inverse() * up_S;
  const MarkerKinematics kinematics(model, setup.joints, markers);
  PostureSearch search(kinematics);
  PostureFitOptions options;
  options.robust_distance = 0.1;
  std::vector<Vector3d> ups;
  for (const Eigen::Matrix3Xd& z : frames) {
    Posture posture;
    search.Assemble(z, scales, options, kAttempts, &posture);
    ups.emplace_back(posture.orientation * up_S);
  }
  return ups;
}

/// Whether the trunk is upright in most frames, z being up by `axis` of the file.
bool IsUpright(const std::vector<Vector3d>& ups, UpAxis now, UpAxis axis) {
  const Vector3d up = RotationToZUp(now) * RotationToZUp(axis).transpose() * Vector3d::UnitZ();
  return 2 * std::count_if(ups.begin(), ups.end(),
                           [&](const Vector3d& one) { return one.dot(up) > kUprightTrunk; }) >
         static_cast<std::ptrdiff_t>(ups.size());
}

}  // namespace

void LetTrunkDecideUpAxis(const TrackingSetup& setup, Input* input, Warnings* warnings) {
  Recording& recording = input->recording;
  if (!recording.up_axis_was_decided || !recording.stated_up_axis) return;
  const UpAxis now = recording.up_axis, stated = *recording.stated_up_axis;
  if (now == stated || setup.model->is_root_fixed() || LabelsOfTrunk(setup) < kFewestOfTrunk) {
    return;
  }
  const std::vector<Vector3d> ups = UpOfTrunk(setup, *input);
  if (!IsUpright(ups, now, stated) || IsUpright(ups, now, now)) return;
  const Eigen::Matrix3d turn = RotationToZUp(stated) * RotationToZUp(now).transpose();
  for (int k = 0; k < recording.markers.num_frames(); ++k) {
    recording.markers.frame(k) = (turn * recording.markers.frame(k)).eval();
  }
  recording.up_axis = stated;
  recording.up_axis_was_decided = false;
  recording.up_axis_is_doubtful = false;
  std::erase_if(recording.doubts,
                [](const ReadingDoubt& doubt) { return doubt.remedy == Remedy::kUpAxis; });
  Warn(warnings,
       fmt::format("the trunk is upright with {} up, which the file states: {} is taken after all",
                   Name(stated), Name(stated)));
}

}  // namespace mmm_converter
