// SPDX-License-Identifier: MIT
#include "common/pipeline/input/finished_motion.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>
#include <vector>

#include "common/support/advice.h"
#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

constexpr double kSameRate = 1e-3;  // relative

}  // namespace

MmmMotion ReadPostures(const std::string& file, const std::string& preferred) {
  MmmMotionFile content = ReadMmmMotionFile(file);
  std::vector<MmmMotion*> candidates;
  std::vector<std::string> names;
  for (MmmMotion& motion : content.motions) {
    const bool has_postures =
        motion.trajectory.num_frames() > 0 && !motion.trajectory.joint_names.empty();
    if (!has_postures) continue;
    if (motion.name == preferred) return std::move(motion);
    candidates.push_back(&motion);
    names.push_back(motion.name);
  }
  if (candidates.empty()) {
    throw Error(fmt::format("{}: has no motion with joint angles; convert it first", file));
  }
  if (candidates.size() > 1) {
    throw Error(fmt::format("{}: has several motions with joint angles ({}); choose one with {}",
                            file, JoinNames(names), OptionText("motion")));
  }
  return std::move(*candidates.front());
}

PoseTrajectory AlignFrames(const PoseTrajectory& trajectory, const MarkerSequence& markers,
                           const std::string& file) {
  if (std::abs(trajectory.rate - markers.rate()) > kSameRate * markers.rate()) {
    throw Error(fmt::format("{}: has {:g} frames a second, the recording {:g}; they must be equal",
                            file, trajectory.rate, markers.rate()));
  }
  const auto first = std::lround((markers.first_time() - trajectory.first_time) * trajectory.rate);
  if (first < 0 || first + markers.num_frames() > trajectory.num_frames()) {
    throw Error(fmt::format(
        "{}: has postures from {:.3f} s to {:.3f} s, the recording is from {:.3f} s to {:.3f} s; "
        "use {} for the part that both have",
        file, trajectory.first_time, trajectory.time(trajectory.num_frames() - 1),
        markers.first_time(), markers.time(markers.num_frames() - 1), OptionText("frames")));
  }
  PoseTrajectory part = trajectory;
  part.first_time = markers.first_time();
  part.postures.assign(trajectory.postures.begin() + first,
                       trajectory.postures.begin() + first + markers.num_frames());
  if (part.standard_deviations.size() > 0) {
    part.standard_deviations =
        Eigen::MatrixXd(trajectory.standard_deviations.middleCols(first, markers.num_frames()));
  }
  for (int k = 0; k < part.num_frames(); ++k) {
    if (part.postures[k].joint_angles.allFinite()) continue;
    throw Error(fmt::format("{}: has no joint angles at {:.3f} s", file, part.time(k)));
  }
  return part;
}

}  // namespace mmm_converter
