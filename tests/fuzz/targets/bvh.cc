// SPDX-License-Identifier: MIT
#include "common/io/bvh/bvh.h"

#include "common/io/recording/recording.h"
#include "common/support/error.h"
#include "tests/fuzz/fuzz_target.h"

namespace mmm_converter::testing {

void ReadBvhBytes(std::string_view bytes) {
  Warnings warnings;
  const Bvh bvh = ParseBvh(bytes, kInputName, &warnings);
  Require(bvh.num_frames() > 0, "frames");
  for (std::size_t j = 0; j < bvh.joints.size(); ++j) {
    Require(bvh.joints[j].parent < static_cast<int>(j), "parents before their children");
  }
  const Recording recording = ReadRecording(FileOf(bytes), {.rate = 100}, &warnings);
  Require(recording.markers.num_frames() == bvh.num_frames(), "all frames");
  for (const SkeletonJoint& joint : recording.body) {
    Require(joint.label < recording.markers.num_labels(), "a label for each joint");
  }
}

}  // namespace mmm_converter::testing
