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

// Times [s], places [m] and angles [rad] beyond this are coarser in double precision than the
// digits that are written.
constexpr double kMostExact = 1e6;

template <typename Numbers>
bool AreExact(const Numbers& numbers) {
  return std::none_of(numbers.data(), numbers.data() + numbers.size(),
                      [](double number) { return std::abs(number) > kMostExact; });
}

bool AreExactTimes(double first_time, double rate, int num_frames) {
  return num_frames == 0 || std::abs(first_time) + num_frames / rate < kMostExact;
}

// Whether a motion has no more digits than are written.
bool IsExact(const MmmMotion& motion) {
  const PoseTrajectory& trajectory = motion.trajectory;
  const MarkerSequence& markers = motion.markers;
  bool is_exact = AreExactTimes(trajectory.first_time, trajectory.rate, trajectory.num_frames()) &&
                  AreExactTimes(markers.first_time(), markers.rate(), markers.num_frames());
  for (const Posture& posture : trajectory.postures) {
    is_exact = is_exact && AreExact(posture.position) && AreExact(posture.joint_angles);
  }
  for (int k = 0; k < markers.num_frames(); ++k) {
    is_exact = is_exact && AreExact(markers.frame(k));
  }
  return is_exact;
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
    Require(
        !IsExact(motion) || Join(FormatMmmMotion2(OutputOfMotion(again.motions.at(0)))) == written,
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
