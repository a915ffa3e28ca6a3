// SPDX-License-Identifier: MIT
// Persons whose bones are not as large as those of the model of OpenSim on which they are tracked.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "common/convert/converter_config.h"
#include "common/io/osim/osim_model_reader.h"
#include "common/io/osim/osim_scaling.h"
#include "common/math/seeded_random.h"
#include "common/model/forward_kinematics.h"
#include "common/motion/marker_synthesis.h"
#include "plugins/s2kf/s2kf_converter.h"
#include "tests/plugins/s2kf/tracking_run.h"
#include "tests/support/osim_texts.h"
#include "tests/support/shared_data.h"

namespace mmm_converter::s2kf {
namespace {

constexpr int kSizedFirstPerson = 701;
constexpr int kSizedPersons = 24;
constexpr int kSizedFrames = 100;
constexpr int kSizedSettled = 25;
constexpr MarkerErrors kSizedErrors{0.003, 0.002, 0.3, 0.0005};

std::string PinText(const std::string& name, const std::string& parent, const std::string& child,
                    const std::string& at) {
  const std::string in = parent == "ground" ? "/ground" : "/bodyset/" + parent;
  return fmt::format(
      "<PinJoint name=\"{0}\"><socket_parent_frame>a</socket_parent_frame><socket_child_frame>"
      "/bodyset/{2}</socket_child_frame><coordinates><Coordinate name=\"{0}_angle\"><range>-1.5 "
      "1.5</range><clamped>true</clamped></Coordinate></coordinates><frames><PhysicalOffsetFrame "
      "name=\"a\"><socket_parent>{1}</socket_parent><translation>{3}</translation><orientation>0 "
      "0 0</orientation></PhysicalOffsetFrame></frames></PinJoint>\n",
      name, in, child, at);
}

/// A pelvis with hips and knees that bend, four markers on each body.
std::string Legs() {
  std::string bodies = testing::OsimBodyText("pelvis");
  std::string joints =
      "<FreeJoint name=\"root\"><socket_parent_frame>/ground</socket_parent_frame>"
      "<socket_child_frame>/bodyset/pelvis</socket_child_frame></FreeJoint>\n";
  std::string markers;
  const auto add_markers = [&](const std::string& body, double up, double down) {
    int i = 0;
    for (const double x : {-0.05, 0.06}) {
      for (const double y : {up, down}) {
        markers += testing::OsimMarkerText(fmt::format("{}_{}", body, i++), body,
                                           fmt::format("{} {} {}", x, y, x * y + 0.05));
      }
    }
  };
  add_markers("pelvis", 0.1, -0.03);
  for (const std::string side : {"r", "l"}) {
    const double z = side == "r" ? 0.09 : -0.09;
    for (const std::string body : {"femur_", "tibia_"}) {
      bodies += testing::OsimBodyText(body + side);
      add_markers(body + side, -0.1, -0.35);
    }
    joints += PinText("hip_" + side, "pelvis", "femur_" + side, fmt::format("-0.05 -0.07 {}", z)) +
              PinText("knee_" + side, "femur_" + side, "tibia_" + side, "0 -0.42 0");
  }
  return testing::OsimText(bodies, joints, "", markers);
}

KinematicModel PersonOf(const std::string& legs, int seed) {
  SeededRandom random(seed);
  OsimScaling scaling;
  for (const std::string body : {"pelvis", "femur_", "tibia_"}) {
    Eigen::Vector3d size = Eigen::Vector3d::Constant(1 + 0.05 * random.Normal());
    for (double& along : size) along += 0.03 * random.Normal();
    if (body == "pelvis") {
      scaling.factors[body] = size;
    } else {
      scaling.factors[body + "r"] = scaling.factors[body + "l"] = size;
    }
  }
  return ParseOsimModel(ScaleOsim(legs, "legs", scaling, nullptr), "legs");
}

PoseTrajectory Walk(const KinematicModel& model, int seed) {
  SeededRandom random(seed);
  PoseTrajectory motion;
  motion.rate = 100;
  std::vector<double> phase;
  for (int j = 0; j < model.num_joints(); ++j) {
    motion.joint_names.push_back(model.joint(j).name);
    phase.push_back(6 * random.Uniform());
  }
  for (int k = 0; k < kSizedFrames; ++k) {
    Posture& q = motion.postures.emplace_back(ZeroPosture(model));
    q.position = {0.01 * k, 0, 0.9};
    for (int j = 0; j < model.num_joints(); ++j) {
      q.joint_angles[j] = 0.1 + 0.6 * std::sin(0.05 * k + phase[static_cast<std::size_t>(j)]);
    }
  }
  return motion;
}

/// Of each angle, errors over deviations: 1 but for a seventh, by the number of persons. Without
/// the sizes, hips and tilts of the pelvis were 1.2 to 1.4.
class SizeDeviationsTest : public ::testing::TestWithParam<const char*> {};

TEST_P(SizeDeviationsTest, AreHonestOfAModelThatWasNotScaled) {
  const std::string legs = Legs();
  const KinematicModel model = ParseOsimModel(legs, "legs");
  std::map<std::string, double> errors, variances;  // of joints and of the root's turns
  for (int seed = kSizedFirstPerson; seed < kSizedFirstPerson + kSizedPersons; ++seed) {
    const KinematicModel person = PersonOf(legs, seed);
    const PoseTrajectory truth = Walk(model, seed);
    const MarkerSequence seen = SynthesizeMarkers(person, truth, kSizedErrors, seed);
    std::vector<MarkerAssignment> assignments;
    for (int m = 0; m < static_cast<int>(model.markers().size()); ++m) {
      const int label = seen.FindLabel(model.markers()[m].name);
      assignments.push_back({LabelIx(label), MarkerIx(m), 1.0});
    }
    std::vector<int> joints;
    for (int j = 0; j < model.num_joints(); ++j) joints.push_back(j);
    S2kfConverter converter(SetupOf(model, joints, assignments),
                            ReadSettings(ReadConverterConfig(testing::SourcePath(
                                "xml_config/converters/" + std::string(GetParam()) + ".xml"))));
    const PoseTrajectory found = converter.Convert(seen, {}).trajectory;
    for (int k = kSizedSettled; k < kSizedFrames; k += 5) {
      const Eigen::VectorXd off = Local(found.postures[k], truth.postures[k]);
      for (int i = 3; i < 6 + model.num_joints(); ++i) {
        const std::string name = i < 6 ? fmt::format("root {}", i - 3) : model.joint(i - 6).name;
        const std::string group = name.substr(0, name.find_last_of('_'));
        errors[group] += off[i] * off[i];
        variances[group] += std::pow(found.standard_deviations(i, k), 2);
      }
    }
  }
  for (const auto& [group, square] : errors) {
    const double ratio = std::sqrt(square / variances[group]);
    std::printf("%s %s: errors are %.2f times their deviations\n", GetParam(), group.c_str(),
                ratio);
    EXPECT_GT(ratio, 0.4) << group;
    EXPECT_LT(ratio, 1.15) << group;
  }
}

INSTANTIATE_TEST_SUITE_P(Presets, SizeDeviationsTest,
                         ::testing::Values("s2kf_default", "s2kf_offline"));

}  // namespace
}  // namespace mmm_converter::s2kf
