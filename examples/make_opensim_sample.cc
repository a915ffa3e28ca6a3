// SPDX-License-Identifier: MIT
// Makes recordings for the model of OpenSim in examples/opensim: a person of other proportions,
// with markers of their own, who stands and then walks, and the walk's true coordinates.
//
//   make_opensim_sample examples/opensim
//
// writes static.trc, walk.trc and walk_true.mot, always the same bytes.
#include <cmath>
#include <exception>
#include <iostream>
#include <map>
#include <numbers>
#include <string>

#include "common/io/bytes/file_content.h"
#include "common/io/osim/osim_model_reader.h"
#include "common/io/osim/osim_scaling.h"
#include "common/io/tables/osim_tables.h"
#include "common/io/tables/trc_writer.h"
#include "common/model/coordinate_map.h"
#include "common/motion/marker_synthesis.h"
#include "common/support/atomic_file.h"

namespace mmm_converter {
namespace {

constexpr double kRate = 100;                                // [Hz]
constexpr double kStride = 1.1;                              // [s]
constexpr MarkerErrors kErrors{0.006, 0.002, 0.25, 0.0002};  // as in a laboratory with care
constexpr int kSeed = 4;

KinematicModel MakePerson(const std::string& folder) {
  const std::string file = folder + "/generic.osim";
  OsimScaling scaling;
  scaling.mass = 68;
  scaling.factors["torso"] = Eigen::Vector3d::Constant(1.04);
  scaling.factors["pelvis"] = Eigen::Vector3d::Constant(0.95);
  for (const char* side : {"_r", "_l"}) {
    scaling.factors[std::string("femur") + side] = Eigen::Vector3d::Constant(1.08);
    scaling.factors[std::string("tibia") + side] = Eigen::Vector3d::Constant(0.97);
    scaling.factors[std::string("foot") + side] = Eigen::Vector3d::Constant(1.05);
  }
  return ParseOsimModel(ScaleOsim(ReadFileContent(file), file, scaling, nullptr), file);
}

/// Coordinates as sums of mean, first and second harmonic of the stride [rad, m]; phase in strides.
struct Swing {
  double mean, first, second, phase;
};

double Value(const Swing& swing, double stride) {
  const double angle = 2 * std::numbers::pi * (stride + swing.phase);
  return swing.mean + swing.first * std::sin(angle) + swing.second * std::sin(2 * angle);
}

PoseTrajectory MakeMotion(const KinematicModel& model, int frames, bool walks) {
  std::map<std::string, Swing> swings = {
      {"pelvis_tilt", {-0.05, 0, 0.02, 0}},   {"pelvis_list", {0, 0.06, 0, 0}},
      {"pelvis_rotation", {0, 0.1, 0, 0.2}},  {"pelvis_ty", {0.98, 0, 0.02, 0.1}},
      {"pelvis_tz", {0, 0.02, 0, 0}},         {"lumbar_extension", {-0.05, 0, 0.02, 0}},
      {"lumbar_rotation", {0, -0.12, 0, 0.2}}};
  for (const auto& [side, phase] : {std::pair("_r", 0.0), {"_l", 0.5}}) {
    const std::string of = side;
    swings["hip_flexion" + of] = {0.15, 0.4, 0.03, phase};
    swings["hip_adduction" + of] = {0, 0.07, 0, phase};
    swings["hip_rotation" + of] = {0, 0.05, 0.02, phase};
    swings["knee_angle" + of] = {-0.45, 0.35, -0.2, phase + 0.35};
    swings["ankle_angle" + of] = {0, 0.15, 0.12, phase + 0.6};
    swings["subtalar_angle" + of] = {0, 0.06, 0, phase};
  }
  PoseTrajectory motion;
  motion.rate = kRate;
  for (int j = 0; j < model.num_joints(); ++j) motion.joint_names.push_back(model.joint(j).name);
  const auto& all = model.coordinates()->coordinates();
  Eigen::VectorXd values(static_cast<Eigen::Index>(all.size()));
  for (int k = 0; k < frames; ++k) {
    const double time = k / kRate;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const auto swing = swings.find(all[i].name);
      double& value = values[static_cast<Eigen::Index>(i)];
      value = walks && swing != swings.end() ? Value(swing->second, time / kStride) : all[i].rest;
      if (walks && all[i].name == "pelvis_tx") value = 1.3 * time;
    }
    motion.postures.push_back(PostureOf(model, values));
  }
  return motion;
}

void WriteRecording(const std::string& file, const std::string& name, const KinematicModel& model,
                    const PoseTrajectory& motion) {
  const MarkerSequence markers = SynthesizeMarkers(model, motion, kErrors, kSeed);
  TrcOutput output;
  output.file_name = name;
  output.measured = &markers;
  WriteFileAtomically(file, FormatTrc(output));
}

void MakeSample(const std::string& folder) {
  const KinematicModel person = MakePerson(folder);
  WriteRecording(folder + "/static.trc", "static.trc", person, MakeMotion(person, 41, false));
  const PoseTrajectory walk = MakeMotion(person, 166, true);
  WriteRecording(folder + "/walk.trc", "walk.trc", person, walk);
  WriteFileAtomically(folder + "/walk_true.mot", FormatOsimMotion(person, walk));
}

}  // namespace
}  // namespace mmm_converter

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "use: make_opensim_sample FOLDER\n";
    return 2;
  }
  try {
    mmm_converter::MakeSample(argv[1]);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
  return 0;
}
