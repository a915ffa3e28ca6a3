// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "common/io/mmm/mmm_motion.h"
#include "tests/fuzz/fuzz_target.h"

namespace mmm_converter::testing {
namespace {

bool IsFinite(const PoseTrajectory& trajectory) {
  return std::all_of(trajectory.postures.begin(), trajectory.postures.end(),
                     [](const Posture& posture) { return posture.joint_angles.allFinite(); });
}

MmmMotionOutput OutputOfMotion(const MmmMotion& motion) {
  MmmMotionOutput output;
  output.motion_name = motion.name;
  output.model_path = motion.model_path;
  output.height = motion.size.height.value_or(0);
  output.mass = motion.size.mass.value_or(0);
  output.hand_length = motion.size.hand_length;
  output.trajectory = &motion.trajectory;
  if (motion.markers.num_frames() > 0) output.markers = &motion.markers;
  return output;
}

}  // namespace

void ReadMmmMotionBytes(std::string_view bytes) {
  LooksLikeMmmMotion(bytes);
  Warnings warnings;
  const MmmMotionFile read = ParseMmmMotionFile(bytes, kInputName, &warnings);
  for (const MmmMotion& motion : read.motions) {
    if (motion.trajectory.num_frames() == 0 || !IsFinite(motion.trajectory)) continue;
    const MmmMotionOutput output = OutputOfMotion(motion);
    FormatMmmMotion1(output)([](std::string_view) {});
    const std::string written = Join(FormatMmmMotion2(output));
    const MmmMotionFile again = ParseMmmMotionFile(written, kInputName);
    Require(Join(FormatMmmMotion2(OutputOfMotion(again.motions.at(0)))) == written,
            "the same bytes when it is read and written again");
    const bool is_alone = std::count_if(read.motions.begin(), read.motions.end(), [&](auto& other) {
                            return other.name == motion.name;
                          }) == 1;
    if (read.version != "2.0" || !is_alone) continue;
    const MmmMotionFile edited = ParseMmmMotionFile(
        Join(WithConvertedMotions(BytesOf(bytes), kInputName, {output})), kInputName);
    Require(edited.motions.size() == read.motions.size(), "all motions of an edited file");
  }
}

}  // namespace mmm_converter::testing
