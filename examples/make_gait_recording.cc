// SPDX-License-Identifier: MIT
// Makes a gait recording: a synthetic person who walks, as a gait laboratory would record one with
// the markers of Plug-in Gait.
//
//   make_gait_recording xml_config/models/mmm.xml examples
//
// writes examples/gait.c3d, always the same bytes.
#include <array>
#include <cmath>
#include <exception>
#include <iostream>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "common/io/c3d/c3d_writer.h"
#include "common/io/mmm/mmm_model.h"
#include "common/math/rotation.h"
#include "common/model/kit_joints.h"
#include "common/model/model_scaling.h"
#include "common/motion/marker_synthesis.h"

namespace mmm_converter {
namespace {

constexpr double kHeight = 1.75;  // [m]
constexpr double kMass = 68;      // [kg]
constexpr double kRate = 100;     // [Hz]
constexpr int kFrames = 489;
constexpr double kBefore = 0.05;  // [strides] from the first frame to a contact of the left heel
// What was made, so that a report can be held against it: the right foot comes to the ground 49 %
// of a stride after the left one, 0.60 m ahead of it, the left one 0.66 m ahead of the right one.
// The left knee bends up to 62 degrees, the right one to 53.
constexpr double kStride = 1.06;  // [s]
constexpr double kLength = 1.26;  // [m] of a stride
constexpr double kDegree = std::numbers::pi / 180;
// A laboratory with care: markers are put on again within some 8 mm, and skin moves by some 3.
constexpr MarkerErrors kErrors{0.008, 0.003, 0.25, 0.0003};
constexpr int kSeed = 7;

/// A Fourier series over the stride from left contact to left contact: mean, then cosine and sine
/// of each harmonic.
using Wave = std::vector<double>;

double Value(const Wave& wave, double stride) {
  double value = wave[0];
  for (std::size_t i = 1; i + 1 < wave.size(); i += 2) {
    const double angle = std::numbers::pi * static_cast<double>(i + 1) * stride;
    value += wave[i] * std::cos(angle) + wave[i + 1] * std::sin(angle);
  }
  return value;
}

/// Of the root, against a point that moves forward at the mean speed: x right, y forward, z up
/// [mm], and its angles [degrees].
const std::array<Wave, 3> kPosition = {{
    {0, -0.2, -12.9, 0, 0, -0.8, 2.3},
    {-34.0, 4.1, 9.6, -8.2, 53.9, -4.4, 3.6},
    {911.5, -0.8, 1.3, -10.7, -5.3, -0.3, 0.2, -3.3, 0.9},
}};
const std::array<Wave, 3> kRollPitchYaw = {{
    {-8.04, -0.25, -0.30, 0.40, -1.07, 0.33, -0.09, -0.24, 0.52},
    {-0.22, 1.12, 0.67, 0.34, -0.14, -1.50, -0.14, -0.07, 0.08},
    {0, -2.26, 5.48, -0.01, 0.14, -0.16, 0.36},
}};

/// Joints of the model [degrees]. Of the legs and the root: curves as textbooks draw them of adults
/// who walk (Winter; Perry and Burnfield), sketched by hand in some ten points, and moved from
/// there by least squares until a foot that stands stays where it is within a millimetre (the heel
/// from 4 to 38 % of its stride, the toes from 10 to 58 %) and nothing goes through the floor. A
/// heel comes to the ground at 0.8 m/s, as recorded ones do.
const std::map<std::string, Wave> kJoints = {
    {"LHx_joint",
     {14.92, 19.01, -3.63, -2.78, -3.24, -0.74, 0.02, -0.43, 0.05, -0.30, 0.60, -0.03, 0.26}},
    {"LHz_joint", {3.52, 0.22, -0.15, 2.13, 2.39, 0.82, -0.56}},
    {"LHy_joint", {-0.48, -0.86, -3.59, -0.90, -0.40, 1.13, 0.53, 0.11, 0.09, 0.07, 0.05}},
    {"LKx_joint",
     {-22.68, 2.25, 20.15, 13.31, -7.10, 0.41, -3.76, -0.67, -0.95, 0.55, 0.18, 0.65, -0.19, 0.23,
      -0.07, 0.03, -0.06}},
    {"LAx_joint",
     {2.00, -2.67, 6.65, 0.74, -5.87, -5.64, 2.02, 2.99, 0.68, 0.43, -1.03, 0.59, -0.45, 0.20,
      -0.80, -0.14, -0.23}},
    {"LAy_joint", {2.60, -0.37, 3.90, -1.13, 0.16, -0.74, 0.64, -0.33, 0.28}},
    {"LFx_joint",
     {10.51, -6.14, -11.43, 3.93, 6.01, -0.04, -7.66, -3.77, 5.13, 4.68, 1.49, 0.73, -1.61}},
    {"RHx_joint",
     {13.93, -19.32, 4.23, -2.79, -3.50, 1.32, -0.33, -0.45, 0.68, -0.20, -0.89, 0.18, 0.07}},
    {"RHz_joint", {-3.53, 0.66, -0.02, -2.21, -2.28, 0.58, -0.54}},
    {"RHy_joint", {0.71, -0.95, -3.81, 0.49, 0.64, 1.13, 0.80, -0.14, -0.30, 0.08, -0.01}},
    {"RKx_joint",
     {-20.98, -3.06, -16.50, 9.96, -8.61, 0.19, 2.56, -0.42, -0.50, -0.83, 0.16, 0.62, -0.47, -0.06,
      0.36, -0.06, -0.06}},
    {"RAx_joint",
     {2.37, 2.52, -6.49, -1.26, -5.97, 4.40, -3.96, 3.83, -0.68, 0.39, 1.20, 0.22, -0.47, 0.08,
      0.50, -0.14, -0.13}},
    {"RAy_joint", {-2.64, -0.22, 3.86, 0.99, -0.38, -0.67, 0.72, 0.29, -0.41}},
    {"RFx_joint",
     {11.07, 6.21, 12.24, 3.00, 4.89, 1.22, 4.89, 1.19, 4.89, -3.99, 3.07, -1.15, -1.42}},
    // Above the pelvis: a thorax that turns against it, a head that looks ahead, arms that swing.
    {"BPx_joint", {3}},
    {"BPz_joint", {0, 2.5, -2}},
    {"BPy_joint", {0, -0.5, -1}},
    {"BTx_joint", {2}},
    {"BTz_joint", {0, 3.5, -2}},
    {"BTy_joint", {0, -0.5, -1}},
    {"BLNx_joint", {2}},
    {"BLNz_joint", {0, -1.5, -0.5}},
    {"BUNz_joint", {0, -1.5, -0.5}},
    {"LSx_joint", {-2, -15, 2}},
    {"RSx_joint", {-2, 15, -2}},
    {"LSy_joint", {9}},
    {"RSy_joint", {-9}},
    {"LEx_joint", {26, -9, 3}},
    {"REx_joint", {26, 9, -3}},
};

PoseTrajectory MakeWalk() {
  PoseTrajectory walk;
  walk.rate = kRate;
  for (const auto& [joint, wave] : kJoints) walk.joint_names.push_back(joint);
  for (int k = 0; k < kFrames; ++k) {
    const double stride = k / kRate / kStride - kBefore;
    Posture posture;
    Eigen::Vector3d rpy;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto row = static_cast<Eigen::Index>(axis);
      posture.position[row] = 1e-3 * Value(kPosition[axis], stride);
      rpy[row] = kDegree * Value(kRollPitchYaw[axis], stride);
    }
    posture.position.y() += kLength * stride;
    posture.orientation = RotationFromRpy(rpy);
    posture.joint_angles.resize(static_cast<Eigen::Index>(kJoints.size()));
    Eigen::Index j = 0;
    for (const auto& [joint, wave] : kJoints) {
      posture.joint_angles[j++] = kDegree * Value(wave, stride);
    }
    walk.postures.push_back(posture);
  }
  return walk;
}

/// Markers of Plug-in Gait on segments of the model of 1 m [mm]. Those of the left side have a
/// counterpart on the right.
struct Worn {
  const char* label;
  const char* segment;
  double x, y, z;
};
constexpr Worn kWorn[] = {
    {"LFHD", "HeadSegment_joint", -37, 43.5, -30},
    {"LBHD", "HeadSegment_joint", -37, -37, -58},
    {"C7", "BLNsegment_joint", 0, -38, 16},
    {"T10", "collarSegment_joint", 0, -65, -112},
    {"CLAV", "BLNsegment_joint", 0, 46, -27},
    {"STRN", "collarSegment_joint", 0, 70, -100},
    {"LSHO", "LSsegment_joint", 15, -1, 20},
    {"LUPA", "LEsegment_joint", -26, 3, 120},
    {"LELB", "LEsegment_joint", -25, 0, 6},
    {"LFRM", "LWsegment_joint", -16, 1, 70},
    {"LWRA", "LWsegment_joint", -12, 29, 0},
    {"LWRB", "LWsegment_joint", -12, -21, 0},
    {"LFIN", "LWy_joint", -9, 3, -46},
    {"LASI", "LHsegment_joint", -18, 34, 42},
    {"LPSI", "LHsegment_joint", 22, -75, 42},
    {"LTHI", "LKsegment_joint", -38, 8, 90},
    {"LKNE", "LKsegment_joint", -33, 0, 2},
    {"LTIB", "LAsegment_joint", -28, 2, 110},
    {"LANK", "LAsegment_joint", -25.5, -6.8, -2},
    {"LHEE", "LAy_joint", -2, -41, -26.5},
    {"LTOE", "LMrot_joint", -10.8, 55.1, -19.2},
};

KinematicModel WithMarkers(const KinematicModel& model) {
  ModelDescription description = DescriptionOf(model);
  description.markers.clear();
  for (const Worn& one : kWorn) {
    const Eigen::Vector3d p_SM = 1e-3 * Eigen::Vector3d(one.x, one.y, one.z);
    description.markers.push_back({one.label, model.FindSegment(one.segment), p_SM});
  }
  for (const Worn& one : kWorn) {
    const std::string label = MirroredName(one.label), segment = MirroredName(one.segment);
    if (label.empty()) continue;
    const Eigen::Vector3d p_SM = 1e-3 * Eigen::Vector3d(-one.x, one.y, one.z);
    const int on = model.FindSegment(segment.empty() ? one.segment : segment);
    description.markers.push_back({label, on, p_SM});
  }
  return KinematicModel(description);
}

void MakeGaitRecording(const std::string& model_file, const std::string& folder) {
  const KinematicModel person =
      ScaleWinter(WithMarkers(ReadMmmModel(model_file)), {kHeight, kMass, {}});
  C3dWriteOptions options;
  options.comment =
      "Synthetic: not a recorded person. A gait with a stiff right knee and a short right step, "
      "height 1.75 m, with misplaced markers, soft tissue and noise. Made by make_gait_recording.";
  WriteC3d(folder + "/gait.c3d", SynthesizeMarkers(person, MakeWalk(), kErrors, kSeed), options);
}

}  // namespace
}  // namespace mmm_converter

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "use: make_gait_recording MODEL.xml FOLDER\n";
    return 2;
  }
  try {
    mmm_converter::MakeGaitRecording(argv[1], argv[2]);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
  return 0;
}
