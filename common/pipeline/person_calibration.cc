// SPDX-License-Identifier: MIT
#include "common/pipeline/person_calibration.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <string>

#include "common/io/mmm/subject_file.h"
#include "common/judge/calibration_verdict.h"
#include "common/motion/marker_noise.h"
#include "common/pipeline/input/matched_labels.h"
#include "common/study/coverage.h"
#include "common/study/label_figures.h"
#include "common/support/advice.h"
#include "common/support/error.h"
#include "common/support/text.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

namespace fs = std::filesystem;

constexpr double kSameHeight = 0.02;  // [m] who is measured twice
// Of places that distances and heights told to some 4 mm, where the model's are off by 28 mm.
constexpr double kToldNoiseScale = 0.15;

// Skin over thighs and shanks slides by 5 to 15 mm in walking, as one for a stride (Leardini et al.
// 2005; Peters et al. 2010) [m].
constexpr double kSkinOfLimbs = 0.008;
// What palpating again changes in angles: 2 to 5 degrees (McGinley et al. 2009) [rad].
constexpr double kMeanPostureDeviation = 3.5 / kDegrees;

std::string FileName(const std::string& path) { return fs::path(path).filename().string(); }

CalibrationInput ReadOne(const InputRequest& request, ConverterConfig* matched,
                         Warnings* warnings) {
  CalibrationInput one;
  one.input = ReadInput(request, {}, warnings);
  const WarningContext context(warnings, request.file, one.input.recording.motion());
  MatchModel(request, &one.input, matched);
  const ConverterConfig& config = *matched;
  if (config.model_processor == "None" && !one.input.model->model.coordinates()) {
    throw Error(WhyUnscaled(config) + ", but a subject is relative to the scaled one");
  }
  const Recording& recording = one.input.recording;
  one.input.keeps_usual_places = true;
  one.setup =
      MatchLabels(LabelsOf(recording.markers, recording.file), &one.input, config, warnings);
  CheckIsSmallEnough(one.input.model_file, static_cast<int>(one.setup.joints.size()), "joints");
  return one;
}

// What one person wears is the same in all recordings: what the names of the recording with most of
// them mean, they mean in all.
void TakeNamesOfOne(const ConverterConfig& config, std::vector<CalibrationInput>* recordings) {
  const Input* most = nullptr;
  for (const CalibrationInput& one : *recordings) {
    const auto& names = one.input.names;
    if (names && (most == nullptr || names->num_used() > most->names->num_used())) {
      most = &one.input;
    }
  }
  if (most == nullptr || recordings->size() == 1) return;
  ConverterConfig of_names = config;
  of_names.marker_pairs = most->names->set.pairs;
  const auto reference = most->reference;
  const auto names = most->names;
  for (CalibrationInput& one : *recordings) {
    const Recording& recording = one.input.recording;
    one.input.reference = reference;
    one.input.names = names;
    one.setup = MatchMarkers(LabelsOf(recording.markers, recording.file), reference, of_names);
    one.setup.marker_set = names->set.name;
  }
}

// Files that know the height must know the same.
void CheckOnePerson(const CalibrationRequest& request,
                    const std::vector<CalibrationInput>& recordings) {
  if (request.inputs.front().person.size.height) return;
  const CalibrationInput* first = nullptr;
  for (const CalibrationInput& one : recordings) {
    const auto height = one.input.recording.size().height;
    if (!height) continue;
    if (first == nullptr) first = &one;
    const double other = *first->input.recording.size().height;
    if (std::abs(*height - other) < kSameHeight) continue;
    throw Error(
        fmt::format("{} is of a person of {:g} m, {} of {:g} m; calibrate with recordings "
                    "of one person, or say with {} which is right",
                    one.input.recording.file, *height, first->input.recording.file, other,
                    OptionText("height")));
  }
}

}  // namespace

void CheckProportions(const Subject& subject) {
  std::vector<std::string> segments;
  for (const SegmentScale& scale : subject.scales) {
    if (scale.scale < kLeastSegmentScale || scale.scale > kLargestSegmentScale) {
      segments.push_back(scale.segment);
    }
  }
  std::vector<std::string> markers;
  for (const MarkerOffset& offset : subject.offsets) {
    if (offset.offset.cwiseAbs().maxCoeff() > kLargestMarkerOffset)
      markers.push_back(offset.marker);
  }
  if (segments.empty() && markers.empty()) return;
  throw Error(
      markers.empty()
          ? fmt::format("no person has these proportions: with segments between half and twice the "
                        "model's length, {} do not fit the markers; check unit, height and labels",
                        FirstNames(segments))
          : fmt::format("the recordings are not of one person with these labels: {} of {} markers "
                        "would sit more than {:.0f} mm from where the model has them ({}); look "
                        "for exchanged labels, another person's markers and the unit",
                        markers.size(), subject.offsets.size(), kMillimetres * kLargestMarkerOffset,
                        FirstNames(markers)));
}

void CheckIsSmallEnough(const std::string& model_file, int count, const char* what) {
  constexpr int kMost = 400;  // 21 s; the work grows with the cube
  if (count <= kMost) return;
  throw Error(fmt::format("{}: has {} {}; persons are calibrated with at most {}", model_file,
                          count, what, kMost));
}

std::vector<CalibrationInput> ReadCalibrationInputs(const CalibrationRequest& request,
                                                    ConverterConfig* config,
                                                    const std::function<void(int, int)>& progress,
                                                    Warnings* warnings) {
  config->subject_file.clear();  // it is what is estimated
  const int num_inputs = static_cast<int>(request.inputs.size());
  std::vector<CalibrationInput> inputs;
  inputs.reserve(request.inputs.size());
  for (int i = 0; i < num_inputs; ++i) {
    if (progress) progress(i, num_inputs);
    Warnings of_one;  // what is said of several recordings is said once
    inputs.push_back(ReadOne(request.inputs[i], config, &of_one));
    warnings->AppendNew(of_one);
  }
  CheckOnePerson(request, inputs);
  TakeNamesOfOne(*config, &inputs);
  return inputs;
}

std::vector<CalibrationRecording> RecordingsOf(const std::vector<CalibrationInput>& inputs) {
  std::vector<CalibrationRecording> recordings;
  recordings.reserve(inputs.size());
  for (const CalibrationInput& one : inputs) {
    recordings.push_back({FileName(one.input.recording.file), &one.input.recording.markers,
                          one.setup.assignments()});
  }
  return recordings;
}

std::string SubjectProgram() { return "MMMConverterS2KF " MMM_CONVERTER_VERSION; }

std::string SubjectName(const Input& input) {
  const Recording& recording = input.recording;
  if (!recording.subject.empty()) return recording.subject;
  if (!recording.motion().empty()) return recording.motion();
  return fs::path(recording.file).stem().string();
}

/// Places that distances between landmarks told are known better than their landmarks are.
std::vector<CalibrationRecording> WithToldPlaces(std::vector<CalibrationRecording> recordings,
                                                 const KinematicModel& scaled,
                                                 const Person& person) {
  if (!person.landmarks) return recordings;
  std::set<std::string> told;
  for (const MarkerOffset& one : person.landmarks->offsets) told.insert(one.marker);
  for (CalibrationRecording& recording : recordings) {
    for (MarkerAssignment& one : recording.assignments) {
      if (told.count(scaled.markers()[one.marker].name) == 0) continue;
      one.noise_scale = std::min(one.noise_scale, kToldNoiseScale);
    }
  }
  return recordings;
}

CalibrationResult CalibratePerson(const KinematicModel& scaled, const std::vector<int>& joints,
                                  const std::vector<CalibrationRecording>& recordings,
                                  const Person& person, const std::string& name, Warnings* warnings,
                                  const std::function<void()>& between_steps) {
  CalibrationOptions options;
  options.between_steps = between_steps;
  options.places_by_noise = person.landmarks != nullptr;
  options.may_stand = options.places_by_noise;
  if (options.places_by_noise) {
    options.skin_deviation = kSkinOfLimbs;
    options.mean_posture_deviation = kMeanPostureDeviation;
  }
  CalibrationResult result = CalibrateSubject(
      scaled, joints, WithToldPlaces(recordings, scaled, person), options, warnings);
  result.subject.name = name;
  result.subject.model = scaled.name();
  result.subject.height = person.height.value;
  result.subject.mass = person.mass.value;
  result.subject.hand_length = person.hand_length;
  if (person.landmarks) {
    result.subject = JoinSubjects(*person.landmarks, result.subject, scaled);
  }
  CheckProportions(result.subject);
  const std::string file = FormatSubject(result.subject, SubjectProgram());
  result.subject = ParseSubject(file, "the estimated subject", scaled);
  return result;
}

Verdict MeasureAndJudge(const CalibrationResult& result,
                        const std::vector<CalibrationInput>& recordings,
                        const PersonScaling& person) {
  CalibrationEvidence evidence{result, {}};
  const Questions asked = AskAboutCalibration(result);
  for (const CalibrationInput& one : recordings) {
    const Recording& recording = one.input.recording;
    MatchedRecording& matched =
        evidence.recordings.emplace_back(MatchedRecording{recording, one.input.names.get()});
    matched.coverage = MeasureCoverage(one.setup);
    matched.noise = MeasureMarkerNoise(recording.markers, LabelIndices(one.setup.assignments()));
    if (!asked.sides) continue;
    matched.sides = FindExchangedSides(one.setup, one.input.reference, person, recording.markers);
  }
  return JudgeCalibration(evidence);
}

CalibrationReport RunCalibration(const CalibrationRequest& request,
                                 WithWarnings<ConverterConfig> configuration,
                                 const std::function<void(int, int)>& progress) {
  CalibrationReport report;
  report.warnings = std::move(configuration.warnings);
  ConverterConfig& config = configuration.value;
  const int num_inputs = static_cast<int>(request.inputs.size());
  report.recordings = ReadCalibrationInputs(request, &config, progress, &report.warnings);
  const Input& first = report.recordings.front().input;
  TrackingSetup setup = report.recordings.front().setup;
  report.person = FindPerson(request.inputs.front().person, setup, first.recording, config,
                             &report.warnings, first.names.get());
  if (!first.recording.body.empty()) report.person.subject = nullptr;  // it is what is estimated
  ScaleToPerson(ScalingOf(report.person, config), &setup);
  const std::vector<CalibrationRecording> recordings = RecordingsOf(report.recordings);
  Warnings warnings;
  report.result =
      CalibratePerson(*setup.model, setup.joints, recordings, report.person,
                      request.name.empty() ? SubjectName(first) : request.name, &warnings, [&] {
                        if (progress) progress(num_inputs, num_inputs);
                      });
  report.warnings.AppendNew(warnings);
  report.person.subject = std::make_shared<Subject>(report.result.subject);
  report.model = std::make_shared<KinematicModel>(
      ScaleModel(*first.reference, ScalingOf(report.person, config)));
  report.verdict =
      MeasureAndJudge(report.result, report.recordings, ScalingOf(report.person, config));
  return report;
}

}  // namespace mmm_converter
