// SPDX-License-Identifier: MIT
// What one file says of others: maps of robots' limbs, set-ups of OpenSim, forces.
#include <fstream>

#include "common/convert/marker_set.h"
#include "common/forces/external_loads.h"
#include "common/io/bytes/file_content.h"
#include "common/io/osim/osim_model_reader.h"
#include "common/io/osim/scale_setup.h"
#include "common/retarget/body_map.h"
#include "tests/common/retarget/biped.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/support/osim_texts.h"

namespace mmm_converter::testing {

void ReadBodyMapBytes(std::string_view bytes) {
  const BodyMapChoice choice = ReadBodyMapChoice(FileOf(bytes));
  if (choice.forward) Require(choice.forward->allFinite(), "a direction");
  static const Robot biped = MakeBiped({});
  try {
    const BodyMap map = FindBodyMap(biped.model, choice);
    Require(map.R_WA.allFinite(), "axes of the body");
  } catch (const Error&) {  // it names joints that another robot has
  }
}

void ReadScaleSetupBytes(std::string_view bytes) {
  const ScaleSetup setup = ParseScaleSetup(bytes, kInputName, [](const std::string&) {
    return std::string("<MarkerSet><objects/></MarkerSet>");
  });
  for (const auto& one : setup.factors) Require(one.factors.allFinite(), "factors");
}

void ReadIkTasksBytes(std::string_view bytes) {
  const MarkerSet set = ReadMarkerSet(FileOf(bytes));
  for (const MarkerPair& pair : set.pairs) {
    Require(pair.noise_scale > 0 && pair.noise_scale < 1e9, "a scale of the noise");
  }
}

/// A table, or loads whose datafile is itself.
void ReadExternalLoadsBytes(std::string_view bytes) {
  const std::string file = FileOf(bytes);
  const std::string table = file.substr(0, file.rfind('/')) + "/table.mot";
  std::ofstream(table) << "endheader\ntime f_vx f_vy f_vz f_px f_py f_pz\n0 1 700 3 0 0 0\n"
                          "0.01 1 700 3 0 0 0\n";
  const RecordedForces forces = ReadExternalLoads(file, Eigen::Vector3d::UnitY(), nullptr);
  Require(forces.rate >= 1 && forces.rate <= 1e5, "a rate that forces have");
  for (const PlateForces& plate : forces.plates) {
    Require(plate.force.cols() == plate.cop.cols(), "as many points as forces");
  }
}

void ReadMarkerFileBytes(std::string_view bytes) {
  Diagnostics diagnostics(kInputName);
  OsimDocument document = ParseOsim(
      OsimText(OsimBodyText("b"), OsimJointText("PinJoint", "j", "ground", "b")), {}, &diagnostics);
  AddOsimMarkers(bytes, kInputName, &document, nullptr);
  Require(document.markers.size() <= 4096, "at most 4096 markers");
  MakeOsimModel(document, &diagnostics);
}

}  // namespace mmm_converter::testing
