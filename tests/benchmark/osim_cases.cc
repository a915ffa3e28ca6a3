// SPDX-License-Identifier: MIT
#include "tests/benchmark/osim_cases.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "common/convert/converter_config.h"
#include "common/io/bytes/file_content.h"
#include "common/io/osim/osim_model_reader.h"
#include "common/io/osim/osim_scaling.h"
#include "common/math/seeded_random.h"
#include "common/model/coordinate_map.h"
#include "common/model/forward_kinematics.h"
#include "common/motion/marker_synthesis.h"
#include "common/osim/osim_calibration.h"
#include "plugins/jacobian/jacobian_converter.h"
#include "plugins/s2kf/s2kf_converter.h"
#include "tests/support/shared_data.h"

namespace mmm_converter {
namespace {

constexpr MarkerErrors kErrors{0.01, 0.004, 0.3, 0.0005};

ModelPtr Parse(const std::string& text) {
  return std::make_shared<const KinematicModel>(ParseOsimModel(text, "model"));
}

/// Every joint swings within its range, twice as fast as slow walking at most.
PoseTrajectory MakeMotion(const KinematicModel& model, int seed) {
  SeededRandom random(2000 + seed);
  PoseTrajectory motion;
  motion.rate = kRate;
  std::vector<std::array<double, 4>> swings;
  for (int j = 0; j < model.num_joints(); ++j) {
    const Segment& joint = model.joint(j);
    motion.joint_names.push_back(joint.name);
    const double half = HasNoLimits(joint) ? 0.5 * joint.reach : 0.5 * (joint.upper - joint.lower);
    const double most = joint.type == JointType::kSliding ? 0.05 : 0.4;
    const double mean = HasNoLimits(joint) ? joint.rest : 0.5 * (joint.upper + joint.lower);
    swings.push_back({std::clamp(mean, joint.rest - 0.3, joint.rest + 0.3),
                      std::min(most, 0.6 * half), 2 + 4 * random.Uniform(), 6 * random.Uniform()});
  }
  for (int k = 0; k < kFrames; ++k) {
    const double t = k / kRate;
    Posture& q = motion.postures.emplace_back(ZeroPosture(model));
    if (!model.is_root_fixed()) {
      q.position = {1.2 * t, 0.02 * std::sin(6 * t), 0.95 + 0.02 * std::sin(12 * t)};
      q.orientation = Eigen::Quaterniond(model.coordinates()->R_WG()) *
                      Eigen::AngleAxisd(0.1 * std::sin(6 * t), Eigen::Vector3d::UnitY());
    }
    for (int j = 0; j < model.num_joints(); ++j) {
      const auto& [mean, reach, speed, phase] = swings[static_cast<std::size_t>(j)];
      double angle = mean + reach * std::sin(speed * t + phase);
      const Segment& joint = model.joint(j);
      if (!HasNoLimits(joint)) angle = std::clamp(angle, joint.lower, joint.upper);
      q.joint_angles[j] = angle;
    }
  }
  return motion;
}

PoseTrajectory Standing(const KinematicModel& model) {
  PoseTrajectory motion;
  motion.rate = kRate;
  for (int j = 0; j < model.num_joints(); ++j) motion.joint_names.push_back(model.joint(j).name);
  motion.postures.assign(static_cast<std::size_t>(kRate) + 1, RestPosture(model));
  return motion;
}

}  // namespace

std::string ReadModelText(const std::string& file) {
  const std::string text = ReadFileContent(file, kMaxOsimBytes);
  Diagnostics diagnostics(file);
  const OsimDocument document = ParseOsim(text, {}, &diagnostics);
  if (!document.markers.empty()) return text;
  SeededRandom random(1);
  std::vector<OsimMarker> markers;
  for (int body = 1; body < static_cast<int>(document.bodies.size()); ++body) {
    for (int i = 0; i < 3; ++i) {
      OsimMarker& marker = markers.emplace_back();
      marker.name = fmt::format("{}_{}", document.bodies[body].name, i);
      marker.body = body;
      marker.p_BM = document.bodies[body].p_BC;
      for (int axis = 0; axis < 3; ++axis) marker.p_BM[axis] += 0.06 * random.Normal();
    }
  }
  return WriteOsimMarkers(text, file, document, markers);
}

std::string GroupOf(std::string name) {
  if (name.ends_with("_r") || name.ends_with("_l")) name.resize(name.size() - 2);
  return name;
}

namespace {

std::map<std::string, Eigen::Vector3d> SizesOf(const std::string& text, int seed) {
  Diagnostics diagnostics("model");
  SeededRandom random(1000 + seed);
  std::map<std::string, Eigen::Vector3d> factors;
  std::map<std::string, Eigen::Vector3d> sizes;  // of both sides
  const auto normal = [&] { return std::clamp(random.Normal(), -2.0, 2.0); };
  for (const OsimBody& body : ParseOsim(text, {}, &diagnostics).bodies) {
    const auto [size, is_new] = sizes.try_emplace(GroupOf(body.name), Eigen::Vector3d::Ones());
    if (is_new) {
      size->second.array() += 0.05 * normal();
      for (double& along : size->second) along += 0.03 * normal();
    }
    if (body.mass > 0) factors[body.name] = size->second;
  }
  return factors;
}

}  // namespace

Case MakeCase(const std::string& text, int seed) {
  Case made;
  made.generic = Parse(text);
  OsimScaling scaling;
  scaling.factors = made.factors = SizesOf(text, seed);
  made.person = Parse(ScaleOsim(text, "model", scaling, nullptr));
  made.truth = MakeMotion(*made.person, seed);
  made.markers = SynthesizeMarkers(*made.person, made.truth, kErrors, seed);
  made.standing = SynthesizeMarkers(*made.person, Standing(*made.person), kErrors, seed);
  // Where each is worn: the same offsets without anything else, seen from the posture of frame 0.
  MarkerErrors worn = kErrors;
  worn.wobble = worn.noise = 0;
  const MarkerSequence still = SynthesizeMarkers(*made.person, made.truth, worn, seed);
  ModelDescription description = DescriptionOf(*made.person);
  const auto poses = SegmentPoses(*made.person, ModelPosture(*made.person, made.truth, 0));
  for (ModelMarker& marker : description.markers) {
    const int label = still.FindLabel(marker.name);
    marker.p_SM = poses[marker.segment].inverse() * still.frame(0).col(label);
    marker.deviation = 0.001;
    marker.skin_deviation = 0.004;
  }
  made.known = std::make_shared<const KinematicModel>(std::move(description));
  return made;
}

Case MoveOtherwise(const Case& made, int seed, int motion_seed) {
  Case other = made;
  other.truth = MakeMotion(*made.person, motion_seed);
  other.markers = SynthesizeMarkers(*made.person, other.truth, kErrors, seed);
  return other;
}

MarkerSequence RecordMotion(const KinematicModel& model, const PoseTrajectory& motion, int seed) {
  PoseTrajectory known;
  known.rate = motion.rate;
  std::vector<int> kept;
  for (std::size_t j = 0; j < motion.joint_names.size(); ++j) {
    if (model.FindJoint(motion.joint_names[j]) < 0) continue;
    kept.push_back(static_cast<int>(j));
    known.joint_names.push_back(motion.joint_names[j]);
  }
  for (const Posture& posture : motion.postures) {
    Posture& q = known.postures.emplace_back(posture);
    q.joint_angles = posture.joint_angles(kept).eval();
  }
  return SynthesizeMarkers(model, known, kErrors, seed);
}

KinematicModel HoldFollowers(const KinematicModel& model) {
  ModelDescription description = DescriptionOf(model);
  for (Segment& segment : description.segments) {
    if (segment.leader < 0 && segment.function == nullptr) continue;
    segment.X_PF = segment.X_PF * JointTransform(segment, segment.rest);
    segment.type = JointType::kFixed;
    segment.lower = segment.upper = segment.rest = segment.reach = 0;
    segment.leader = -1;
    segment.function = nullptr;
  }
  description.coordinates = nullptr;
  return KinematicModel(std::move(description));
}

ConversionResult Track(const ModelPtr& model, const std::string& preset,
                       const MarkerSequence& seen) {
  ConverterConfig config =
      ReadConverterConfig(testing::SourcePath("xml_config/converters/" + preset + ".xml"));
  config.marker_set = "auto";
  config.joint_set = "auto";
  config.model_processor = "None";
  TrackingSetup setup = MakeTrackingSetup(LabelsOf(seen), model, config, {});
  if (preset.starts_with("jacobian")) {
    return jacobian::JacobianConverter(std::move(setup), jacobian::ReadSettings(config))
        .Convert(seen, nullptr);
  }
  return s2kf::S2kfConverter(std::move(setup), s2kf::ReadSettings(config)).Convert(seen, nullptr);
}

CalibratedPerson Calibrate(const std::string& text, const Case& made) {
  Diagnostics diagnostics("model");
  const OsimDocument document = ParseOsim(text, {}, &diagnostics);
  ConverterConfig config =
      ReadConverterConfig(testing::SourcePath("xml_config/converters/s2kf_default.xml"));
  config.marker_set = config.joint_set = "auto";
  config.model_processor = "None";
  std::vector<CalibrationRecording> recordings;
  TrackingSetup setup;
  for (const MarkerSequence* markers : {&made.standing, &made.markers}) {
    setup = MakeTrackingSetup(LabelsOf(*markers), made.generic, config, {});
    recordings.push_back({"", markers, setup.assignments()});
  }
  const CalibratedOsim found = CalibrateOsim({text, "model"}, document, *made.generic, setup.joints,
                                             recordings, {}, OsimCalibrationOptions(), nullptr);
  CalibratedPerson person;
  person.factors = found.scaled.factors;
  person.iterations = found.result.iterations;
  person.model = found.model;
  person.subject = found.result.subject;
  person.size = found.size;
  return person;
}

}  // namespace mmm_converter
