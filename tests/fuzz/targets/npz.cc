// SPDX-License-Identifier: MIT
#include "common/io/npz/npz_file.h"
#include "common/io/recording/recording.h"
#include "common/support/error.h"
#include "tests/fuzz/fuzz_target.h"

namespace mmm_converter::testing {

void ReadNpzBytes(std::string_view bytes) {
  const std::string file = FileOf(bytes);
  if (!LooksLikeNpy(bytes)) {
    const NpzFile archive(file);
    for (const std::string& name : archive.names()) archive.Start(name, 100);
    if (!LooksLikeNpz(bytes)) return;
  }
  Warnings warnings;
  const Recording recording = ReadRecording(file, {.rate = 100}, &warnings);
  Require(recording.markers.num_frames() > 0, "frames");
  for (const SkeletonJoint& joint : recording.body) {
    Require(joint.label < recording.markers.num_labels(), "a label for each joint");
  }
}

}  // namespace mmm_converter::testing
