// SPDX-License-Identifier: MIT
#include "tests/report/comparison_cases.h"

#include "common/io/mmm/mmm_model.h"
#include "common/model/model_scaling.h"
#include "common/motion/marker_synthesis.h"
#include "common/motion/synthetic_motion.h"
#include "tests/support/long_recording.h"
#include "tests/support/stick_model.h"

namespace mmm_converter::testing {
namespace {

constexpr double kRate = 100;  // [Hz]

// The stick with a hostile name for each of its parts.
KinematicModel HostileModel() {
  const KinematicModel stick = StickModel();
  ModelDescription description;
  description.name = kHostileText;
  description.segments = stick.segments();
  for (Segment& segment : description.segments) segment.name += kHostileText;
  description.markers = stick.markers();
  for (ModelMarker& marker : description.markers) marker.name += kHostileText;
  return KinematicModel(description);
}

PoseTrajectory SwayingMotion(const KinematicModel& model, int frames) {
  PoseTrajectory motion;
  motion.rate = kRate;
  for (int i = 0; i < model.num_joints(); ++i) motion.joint_names.push_back(model.joint(i).name);
  for (int k = 0; k < frames; ++k) {
    Posture posture = ZeroPosture(model);
    posture.joint_angles.setConstant(0.5 * std::sin(0.1 * k));
    motion.postures.push_back(posture);
  }
  return motion;
}

MarkerMapping MapAll(const KinematicModel& model) {
  MarkerMapping mapping;
  for (int i = 0; i < static_cast<int>(model.markers().size()); ++i) {
    mapping.assignments.push_back({LabelIx(i), MarkerIx(i)});
  }
  return mapping;
}

Finished AsFinished(const KinematicModel& model, const PoseTrajectory& motion) {
  Finished finished;
  finished.mapping = MapAll(model);
  finished.result.trajectory = motion;
  finished.result.frames.resize(motion.num_frames());
  for (FrameDiagnostic& frame : finished.result.frames) frame.seconds = 0.0005;
  return finished;
}

Trial MakeTrial(const KinematicModel& model, const PoseTrajectory& motion) {
  Trial trial;
  trial.model = std::make_shared<KinematicModel>(model);
  trial.markers = SynthesizeMarkers(model, motion, MarkerErrors{}, 1);
  return trial;
}

// Of the hostile model; the second segment is hardly determined.
Subject HostileSubject(const KinematicModel& model) {
  Subject subject;
  subject.name = kHostileText;
  subject.model = model.name();
  subject.height = 1.8;
  subject.mass = 75;
  subject.scales = {{model.segments()[1].name, 0.98, 0.005, 0.06},
                    {model.segments()[2].name, 1.05, 0.05, 0.06}};
  for (const ModelMarker& marker : model.markers()) {
    MarkerOffset offset;
    offset.marker = marker.name;
    offset.offset = {0.01 * (1 + marker.segment), 0, 0};
    offset.standard_deviations = {0.001, 0.001, 0.001};
    offset.prior_deviation = 0.04;
    subject.offsets.push_back(offset);
  }
  subject.sources = {{kHostileText, 50}};
  return subject;
}

Contender HostileContender() {
  Contender contender;
  contender.name = kHostileText;
  contender.configuration = kHostileText;
  return contender;
}

}  // namespace

Comparison HostileComparison() {
  const KinematicModel model = HostileModel();
  const PoseTrajectory motion = SwayingMotion(model, 50);
  Trial trial = MakeTrial(model, motion);
  trial.name = kHostileText;
  trial.subject = std::make_shared<Subject>(HostileSubject(model));
  Finished finished = AsFinished(model, motion);
  finished.warnings.Add(kHostileText);
  finished.mapping.ignored_labels = {kHostileText};
  finished.mapping.absent_markers = {kHostileText};
  Comparison comparison =
      CompareFinished(trial, {HostileContender(), HostileContender()}, {finished, finished});
  comparison.rows[1].failure = kHostileText;
  return comparison;
}

Comparison FailedComparison() {
  Comparison comparison;
  comparison.trials.resize(1);
  comparison.trials[0].name = "unreadable.c3d";
  comparison.trials[0].failure = "unreadable.c3d: no such file";
  comparison.contenders.resize(1);
  comparison.contenders[0].name = "any";
  comparison.grounds.resize(1);
  comparison.rows.resize(1);
  comparison.rows[0].failure = comparison.trials[0].failure;
  return comparison;
}

Comparison LongComparison() {
  const std::string file = MMM_CONVERTER_SOURCE_DIR "/xml_config/models/mmm.xml";
  const KinematicModel model = ScaleWinter(ReadMmmModel(file), {1.8, 75, {}});
  const PoseTrajectory handstand = MakeHandstand(model);
  PoseTrajectory motion = handstand;
  constexpr int kFrames = 6000;
  motion.postures.clear();
  motion.postures.reserve(kFrames);
  for (int k = 0; k < kFrames; ++k) {
    motion.postures.push_back(handstand.postures[FrameBackAndForth(k, handstand.num_frames())]);
  }
  const auto num_joints = static_cast<Eigen::Index>(motion.joint_names.size());
  // Numbers that differ from each other, like those of a filter.
  motion.standard_deviations =
      (Eigen::MatrixXd::Random(6 + num_joints, kFrames).array() + 2) * 0.01;
  Trial trial = MakeTrial(model, motion);
  trial.name = "60 s";
  return CompareFinished(
      trial,
      {Contender{
          .name = "truth", .configuration = "", .config = {}, .plugin = nullptr, .failure = ""}},
      {AsFinished(model, motion)});
}

Comparison Repeated(Comparison comparison, int times) {
  const auto repeat = [&](Eigen::VectorXd* frames) {
    *frames = frames->replicate(times, 1).eval();
  };
  for (std::size_t t = 0; t < comparison.trials.size(); ++t) {
    MarkerSequence& markers = comparison.trials[t].markers;
    markers = Lengthen(markers, times * markers.num_frames());
    CommonGround& ground = comparison.grounds[t];
    ground.hidden = ground.hidden.replicate(1, times).eval();
    for (Eigen::VectorXd* frames : {&ground.optimum, &ground.mean_hidden, &ground.most_hidden}) {
      repeat(frames);
    }
  }
  for (ComparisonRow& row : comparison.rows) {
    row.distances = row.distances.replicate(1, times).eval();
    for (Eigen::VectorXd* frames :
         {&row.mean_distance, &row.p05_distance, &row.p95_distance, &row.max_distance}) {
      repeat(frames);
    }
    PoseTrajectory& motion = row.result.trajectory;
    motion.standard_deviations = motion.standard_deviations.replicate(1, times).eval();
    const std::vector<Posture> postures = motion.postures;
    const std::vector<FrameDiagnostic> diagnostics = row.result.frames;
    for (int i = 1; i < times; ++i) {
      motion.postures.insert(motion.postures.end(), postures.begin(), postures.end());
      row.result.frames.insert(row.result.frames.end(), diagnostics.begin(), diagnostics.end());
    }
  }
  return comparison;
}

Comparison ThinnedComparison() {
  const KinematicModel model = StickModel();
  PoseTrajectory motion = SwayingMotion(model, 13'000);
  Trial trial = MakeTrial(model, motion);
  trial.name = "130 s";
  motion.postures[6502].position.x() += 0.5;  // frames 6501 and 6504 are drawn
  Contender contender;
  contender.name = "truth";
  return CompareFinished(trial, {contender}, {AsFinished(model, motion)});
}

}  // namespace mmm_converter::testing
