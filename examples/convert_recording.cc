// SPDX-License-Identifier: MIT
//
// A recording converted whole: what `MMMConverterS2KF convert` does, in the library's own words.
//
//   convert_recording RECORDING HEIGHT_M OUTPUT.xml

#include <exception>
#include <iostream>
#include <string>

#include "common/convert/marker_mapping.h"
#include "common/convert/plugin_loader.h"
#include "common/io/mmm/mmm_model.h"
#include "common/io/mmm/mmm_motion.h"
#include "common/io/recording/recording.h"
#include "common/model/model_scaling.h"
#include "common/support/atomic_file.h"
#include "common/support/data_directory.h"

namespace mmm_converter {
namespace {

constexpr double kMass = 70;  // [kg]; it matters to later dynamics only, not to the tracking

void Run(const std::string& input, double height, const std::string& output) {
  // The markers in metres, z up, NaN where a marker is not seen.
  const Recording recording = ReadRecording(input, {});

  // The reference model is a person of 1 m and 1 kg; Winter's rule scales it to ours.
  const std::string model_file = DataFile("models/mmm.xml");
  const KinematicModel model =
      ScaleWinter(ReadMmmModel(model_file), {.height = height, .mass = kMass, .hand_length = {}});

  // The plugin must outlive the converter. Its template is also its default configuration.
  const LoadedPlugin plugin = LoadPluginByName("S2KFConverter");
  const ConverterConfig config =
      ParseConverterConfig(plugin.factory().config_template(), "default configuration");

  // Labels are matched with the model's markers once; from here on there are only indices.
  std::string set;
  const MarkerMapping mapping = ResolveMarkerMapping(
      ResolveMarkerPairs(config, recording.markers, model, &set), recording.markers, model);
  const auto converter = plugin.factory().Create(model, mapping.assignments, config);
  const ConversionResult result =
      converter->Convert(recording.markers, model, mapping.assignments, {});

  MmmMotionOutput motion;
  motion.motion_name = "converted";
  motion.model_path = ModelPathFor(model_file, output);
  motion.height = height;
  motion.mass = kMass;
  motion.trajectory = &result.trajectory;
  motion.markers = &recording.markers;
  WriteFileAtomically(output, FormatMmmMotion2(motion));

  const auto seen = result.residuals.array().isFinite();
  std::cout << "marker set " << set << ", " << mapping.assignments.size() << " markers, "
            << result.trajectory.num_frames() << " frames; mean marker distance "
            << 1e3 * seen.select(result.residuals, 0).sum() / static_cast<double>(seen.count())
            << " mm\n";
}

}  // namespace
}  // namespace mmm_converter

int main(int argc, char** argv) {
  if (argc != 4) {
    std::cerr << "usage: convert_recording RECORDING HEIGHT_M OUTPUT.xml\n";
    return 2;
  }
  try {
    mmm_converter::Run(argv[1], std::stod(argv[2]), argv[3]);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
  return 0;
}
