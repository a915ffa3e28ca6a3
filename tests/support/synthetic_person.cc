// SPDX-License-Identifier: MIT
#include "tests/support/synthetic_person.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>

#include "common/calibrate/segment_lengths.h"
#include "common/convert/converter_config.h"
#include "common/fit/posture_search.h"
#include "common/io/mmm/mmm_model.h"
#include "common/math/rotation.h"
#include "common/math/seeded_random.h"
#include "common/model/forward_kinematics.h"
#include "common/model/kit_joints.h"
#include "common/model/model_scaling.h"
#include "common/motion/marker_synthesis.h"
#include "common/support/units.h"
#include "tests/support/all_indices.h"
#include "tests/support/shared_data.h"

namespace mmm_converter::testing {

using Eigen::Vector3d;

namespace {

constexpr double kLengthShare = 0.05;

Vector3d DrawVector(double deviation, SeededRandom* random) {
  Vector3d v;
  for (int i = 0; i < 3; ++i) v[i] = deviation * random->Normal();
  return v;
}

}  // namespace

KinematicModel ScaledReferenceModel(double height) {
  return ScaleWinter(ReadMmmModel(SourcePath("xml_config/models/mmm.xml")), {height, 70, {}});
}

std::vector<int> TrackedJoints(const KinematicModel& model) {
  ConverterConfig config;
  config.joint_set = "mmm44";
  return ResolveJoints(config, model);
}

Subject DrawPerson(const KinematicModel& model, std::uint64_t seed, double marker_deviation) {
  SeededRandom random(seed);
  const auto markers = AllIndices<MarkerIx>(model.markers().size());
  const SegmentLengths lengths = FindSegmentLengths(model, TrackedJoints(model), markers);
  Subject subject;
  for (const int s : lengths.segments) {
    const double scale = 1 + kLengthShare * (2 * random.Uniform() - 1);
    subject.scales.push_back({model.segments()[s].name, scale, 0, 0});
  }
  for (const auto& [left, right] : lengths.mirror) {
    subject.scales[right].scale = subject.scales[left].scale;
  }
  std::map<std::string, Vector3d> mirrored;  // by the right marker's name
  const double half = marker_deviation / std::numbers::sqrt2;
  for (const ModelMarker& marker : model.markers()) {
    const std::string name = marker.name.substr(std::string("MARKER_").size());
    const bool is_left = model.FindMarker("MARKER_" + MirroredName(name)) >= 0 && name[0] == 'L';
    const std::string key = is_left ? MirroredName(name) : name;
    const auto found = mirrored.emplace(key, DrawVector(half, &random)).first;
    Vector3d common = found->second;
    if (is_left) common.x() = -common.x();
    MarkerOffset offset;
    offset.marker = marker.name;
    offset.offset = common + DrawVector(half, &random);
    subject.offsets.push_back(offset);
  }
  return subject;
}

/// As far as standing people bend a joint: their weight bends hips and ankles further.
double UpperOfStanding(const Segment& joint) {
  if (joint.name.ends_with("Hx_joint")) return std::min(joint.upper, 95 / kDegrees);
  return joint.name.ends_with("Ax_joint") ? std::min(joint.upper, 30 / kDegrees) : joint.upper;
}

PoseTrajectory RangeOfMotion(const KinematicModel& model, double seconds, double share,
                             std::uint64_t seed) {
  SeededRandom random(seed);
  const std::vector<int> joints = TrackedJoints(model);
  PoseTrajectory motion;
  motion.rate = 100;
  std::vector<double> frequency;
  std::vector<double> phase;
  for (const int joint : joints) {
    motion.joint_names.push_back(model.joint(joint).name);
    frequency.push_back(0.15 + 0.35 * random.Uniform());
    phase.push_back(2 * std::numbers::pi * random.Uniform());
  }
  for (int k = 0; k < seconds * motion.rate; ++k) {
    const double t = k / motion.rate;
    Posture q;
    q.position = Vector3d(0.3 * std::sin(0.3 * t), 0.2 * std::sin(0.2 * t), 1);
    q.orientation =
        Exp(Vector3d(0.2 * std::sin(0.5 * t), 0.2 * std::sin(0.4 * t), std::sin(0.25 * t)));
    q.joint_angles.resize(static_cast<Eigen::Index>(joints.size()));
    for (std::size_t j = 0; j < joints.size(); ++j) {
      const Segment& joint = model.joint(joints[j]);
      const double upper = UpperOfStanding(joint);
      const double swing = std::sin(2 * std::numbers::pi * frequency[j] * t + phase[j]);
      q.joint_angles[static_cast<Eigen::Index>(j)] =
          0.5 * share * (joint.lower + upper + swing * (upper - joint.lower));
    }
    motion.postures.push_back(q);
  }
  return motion;
}

MarkerSequence RecordPerson(const KinematicModel& person, const PoseTrajectory& motion,
                            std::uint64_t seed) {
  MarkerErrors errors;
  errors.offset = 0;
  return SynthesizeMarkers(person, motion, errors, seed);
}

std::vector<MarkerAssignment> AssignAll(const KinematicModel& model,
                                        const MarkerSequence& recording) {
  std::vector<MarkerAssignment> assignments;
  for (int i = 0; i < recording.num_labels(); ++i) {
    const int marker = model.FindMarker("MARKER_" + recording.labels()[i]);
    if (marker >= 0) assignments.push_back({LabelIx(i), MarkerIx(marker)});
  }
  return assignments;
}

TrackingSetup SetupOf(const KinematicModel& model, std::vector<int> joints,
                      std::vector<MarkerAssignment> assignments) {
  TrackingSetup setup{std::make_shared<const KinematicModel>(model), std::move(joints), {}};
  setup.mapping.assignments = std::move(assignments);
  return setup;
}

double MeanCentreError(const KinematicModel& person, const PoseTrajectory& truth,
                       const KinematicModel& model, const PoseTrajectory& estimate) {
  const std::vector<int> joints = TrackedJoints(model);
  double sum = 0;
  for (int k = 0; k < truth.num_frames(); ++k) {
    const auto X_true = SegmentPoses(person, ModelPosture(person, truth, k));
    const auto X = SegmentPoses(model, ModelPosture(model, estimate, k));
    for (const int joint : joints) {
      const int s = model.joint_segment(joint);
      sum += (X_true[s].translation() - X[s].translation()).norm();
    }
  }
  return sum / (truth.num_frames() * static_cast<double>(joints.size()));
}

PoseTrajectory FitRecording(const KinematicModel& model, const std::vector<int>& joints,
                            const std::vector<MarkerAssignment>& assignments,
                            const MarkerSequence& recording) {
  const std::vector<LabelIx> labels = LabelIndices(assignments);
  const MarkerKinematics kinematics(model, joints, MarkerIndices(assignments));
  PostureSearch search(kinematics);
  PostureFitOptions options;
  options.robust_distance = 0.1;
  const Eigen::VectorXd scale = Eigen::VectorXd::Ones(kinematics.num_markers());
  PoseTrajectory result;
  result.rate = recording.rate();
  for (const int joint : joints) result.joint_names.push_back(model.joint(joint).name);
  Posture q;
  for (int k = 0; k < recording.num_frames(); ++k) {
    const Eigen::Matrix3Xd z = recording.frame(k)(Eigen::all, labels);
    if (k == 0) {
      search.Assemble(z, scale, options, 4, &q);
    } else {
      search.fit().Solve(z, scale, options, &q);
    }
    result.postures.push_back(q);
  }
  return result;
}

double MeanDistance(const KinematicModel& model, const std::vector<MarkerAssignment>& assignments,
                    const MarkerSequence& recording, const PoseTrajectory& estimate) {
  double sum = 0;
  long seen = 0;
  for (int k = 0; k < recording.num_frames(); ++k) {
    const Eigen::Matrix3Xd p = MarkerPositions(model, ModelPosture(model, estimate, k));
    for (const MarkerAssignment& assignment : assignments) {
      const double d = (recording.frame(k).col(assignment.label) - p.col(assignment.marker)).norm();
      if (!std::isfinite(d)) continue;
      sum += d;
      ++seen;
    }
  }
  return sum / static_cast<double>(seen);
}

}  // namespace mmm_converter::testing
