// SPDX-License-Identifier: MIT
// Makes the sample recording: a synthetic handstand as an optical system would record it, and the
// true motion beside it.
//
//   make_sample_recording xml_config/models/mmm.xml examples
//
// writes examples/handstand.c3d and examples/handstand_true.xml, always the same bytes.
#include <exception>
#include <iostream>
#include <string>

#include "common/io/c3d/c3d_writer.h"
#include "common/io/mmm/mmm_model.h"
#include "common/io/mmm/mmm_motion.h"
#include "common/model/model_scaling.h"
#include "common/motion/marker_synthesis.h"
#include "common/motion/synthetic_motion.h"
#include "common/support/atomic_file.h"

namespace mmm_converter {
namespace {

constexpr double kHeight = 1.8;  // [m]
constexpr double kMass = 75;     // [kg]
constexpr int kSeed = 1;

void MakeSampleRecording(const std::string& model_file, const std::string& folder) {
  const KinematicModel model = ScaleWinter(ReadMmmModel(model_file), {kHeight, kMass, {}});
  const PoseTrajectory truth = MakeHandstand(model);

  // Markers as real recordings show them: 28 mm off the model's places, on soft tissue, with noise.
  const MarkerSequence markers = SynthesizeMarkers(model, truth, MarkerErrors{}, kSeed);
  C3dWriteOptions options;
  options.comment =
      "Synthetic: not a recorded person. Handstand of the MMM model, height 1.80 m, with misplaced "
      "markers, soft tissue and noise. Made by make_sample_recording.";
  WriteC3d(folder + "/handstand.c3d", markers, options);

  MmmMotionOutput output;
  output.recording_name = "synthetic handstand";
  output.motion_name = "synthetic_subject";
  output.model_path = "../xml_config/models/mmm.xml";
  output.height = kHeight;
  output.mass = kMass;
  output.trajectory = &truth;
  WriteFileAtomically(folder + "/handstand_true.xml", FormatMmmMotion2(output));
}

}  // namespace
}  // namespace mmm_converter

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "use: make_sample_recording MODEL.xml FOLDER\n";
    return 2;
  }
  try {
    mmm_converter::MakeSampleRecording(argv[1], argv[2]);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
  return 0;
}
