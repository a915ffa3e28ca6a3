// SPDX-License-Identifier: MIT
//
// A recording converted whole: what `MMMConverterS2KF convert` does, in the library's own words.
//
//   convert_recording RECORDING HEIGHT_M OUTPUT.xml

#include <exception>
#include <iostream>
#include <memory>
#include <string>

#include "common/convert/plugin_loader.h"
#include "common/convert/tracking_setup.h"
#include "common/io/mmm/mmm_model.h"
#include "common/io/mmm/mmm_motion.h"
#include "common/io/recording/recording.h"
#include "common/support/atomic_file.h"
#include "common/support/data_directory.h"

namespace mmm_converter {
namespace {

constexpr double kMass = 70;  // [kg]; it matters to later dynamics only, not to the tracking

void Run(const std::string& input, double height, const std::string& output) {
  // The markers in metres, z up, NaN where a marker is not seen.
  const Recording recording = ReadRecording(input, {});

  // The plugin must outlive the converter. Its template is also its default configuration.
  const LoadedPlugin plugin = LoadPluginByName("S2KFConverter");
  const ConverterConfig config =
      ParseConverterConfig(plugin.factory().config_template(), "default configuration");

  // The reference model is a person of 1 m and 1 kg; Winter's rule scales it to ours. Labels are
  // matched with its markers once; from here on there are only indices.
  const std::string model_file = DataFile("models/mmm.xml");
  const auto reference = std::make_shared<const KinematicModel>(ReadMmmModel(model_file));
  const TrackingSetup setup =
      MakeTrackingSetup(LabelsOf(recording.markers, recording.file), reference, config,
                        {.size = WinterScaling{height, kMass, {}}});
  const auto converter = plugin.factory().Create(setup, config);
  const ConversionResult result = converter->Convert(recording.markers, {});

  MmmMotionOutput motion;
  motion.motion_name = "converted";
  motion.model_path = ModelPathFor(model_file, output);
  motion.height = height;
  motion.mass = kMass;
  motion.trajectory = &result.trajectory;
  motion.markers = &recording.markers;
  WriteFileAtomically(output, FormatMmmMotion2(motion));

  const auto seen = result.residuals.array().isFinite();
  std::cout << "marker set " << setup.marker_set << ", " << setup.assignments().size()
            << " markers, " << result.trajectory.num_frames() << " frames; mean marker distance "
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
