// SPDX-License-Identifier: MIT
#include "tests/fuzz/fuzz_target.h"

#include <fstream>
#include <stdexcept>

#include "common/support/error.h"
#include "tests/support/test_folder.h"

namespace mmm_converter::testing {

const std::map<std::string, FuzzTarget>& FuzzTargets() {
  static const std::map<std::string, FuzzTarget> targets = {
      {"body_map", ReadBodyMapBytes},
      {"bvh", ReadBvhBytes},
      {"c3d", ReadC3dBytes},
      {"conversion", ConvertRecordingBytes},
      {"converter_config", ReadConverterConfigBytes},
      {"external_loads", ReadExternalLoadsBytes},
      {"ik_tasks", ReadIkTasksBytes},
      {"journal", ReadJournalBytes},
      {"lcd_samples", ReadLcdSamplesBytes},
      {"manifest", ReadManifestBytes},
      {"marker_file", ReadMarkerFileBytes},
      {"marker_set", ReadMarkerSetBytes},
      {"mesh", ReadMeshBytes},
      {"mjcf", ReadMjcfBytes},
      {"mmm_model", ReadMmmModelBytes},
      {"mmm_motion", ReadMmmMotionBytes},
      {"motive_csv", ReadMotiveCsvBytes},
      {"natnet", ReadNatNetBytes},
      {"nexus_csv", ReadNexusCsvBytes},
      {"npz", ReadNpzBytes},
      {"osim", ReadOsimBytes},
      {"osim_setup", ReadOsimSetupBytes},
      {"person", ReadPersonBytes},
      {"points_csv", ReadPointsCsvBytes},
      {"qtm", ReadQtmBytes},
      {"qtm_tsv", ReadQtmTsvBytes},
      {"recording", ReadRecordingBytes},
      {"scale_setup", ReadScaleSetupBytes},
      {"subjects_table", ReadSubjectsTableBytes},
      {"trc", ReadTrcBytes},
      {"urdf", ReadUrdfBytes},
  };
  return targets;
}

std::string Refusal(FuzzTarget target, std::string_view bytes) {
  try {
    target(bytes);
    return "";
  } catch (const Error& error) {
    std::string message = error.what();
    Require(message.find(kInputName) != std::string::npos,
            "an error that names the file, not \"" + message + "\"");
    return message;
  }
}

std::string FileOf(std::string_view bytes) {
  static const TemporaryFolder folder;
  std::string path = folder.path() + "/" + kInputName;
  std::ofstream(path, std::ios::binary) << bytes;
  return path;
}

void Require(bool holds, const std::string& expected) {
  if (!holds) throw std::logic_error("expected: " + expected);
}

}  // namespace mmm_converter::testing
