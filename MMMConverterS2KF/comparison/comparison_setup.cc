// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/comparison/comparison_setup.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "MMMConverterS2KF/terminal/advice.h"
#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

namespace fs = std::filesystem;

constexpr double kSameRate = 1e-3;  // relative

template <typename Named>
void NumberRepeatedNames(std::vector<Named>* items) {
  std::map<std::string, int> count;
  for (Named& item : *items) {
    const int number = ++count[item.name];
    if (number > 1) item.name += fmt::format(" ({})", number);
  }
}

void TakeModel(const InputRequest& request, ConverterConfig config, Input* read, Trial* trial,
               Warnings* warnings) {
  MatchModel(request, read, &config);
  const Input& input = *read;
  const Recording& recording = input.recording;
  TrackingSetup setup = MatchMarkers(LabelsOf(recording.markers, recording.file), input.reference,
                                     config, nullptr);  // each row says it
  WarnOfFreeJoints(setup, config, warnings);
  const Person person = FindPerson(request.person, setup, recording, config, warnings);
  ScaleToPerson(ScalingOf(person, config), &setup);
  trial->model = setup.model;
  trial->subject = person.subject;
}

}  // namespace

Contender MakeContender(const std::string& config) {
  Contender contender;
  contender.name = config.empty() ? "s2kf_default" : fs::path(config).stem().string();
  try {
    ConverterChoice choice = ChooseConverter({config, "", ""}, nullptr);
    contender.config = std::move(choice.config);
    contender.configuration = std::move(choice.text);
    contender.plugin = std::move(choice.plugin);
  } catch (const Error& error) {
    contender.failure = WithAdvice(error);
  }
  return contender;
}

void NameInputs(const Contender& contender, OutputPlan* plan) {
  NameInputs(ConverterChoice{contender.config, "", contender.plugin}, plan);
}

Trial MakeTrial(InputRequest request, const std::string& truth_file, const ConverterConfig& config,
                Warnings* warnings) {
  Trial trial;
  trial.name = fs::path(request.file).filename().string();
  try {
    Warnings of_input;
    Input input = ReadInput(request, {}, &of_input);
    warnings->Append(of_input);
    const WarningContext context(warnings, request.file, input.recording.motion());
    if (!truth_file.empty()) {
      const MmmMotion truth = ReadPostures(truth_file, input.recording.motion());
      trial.truth = AlignFrames(truth.trajectory, input.recording.markers, truth_file);
      if (request.person.subject_file.empty()) {
        if (!request.person.size.height) request.person.size.height = truth.size.height;
        if (!request.person.size.mass) request.person.size.mass = truth.size.mass;
      }
    }
    TakeModel(request, config, &input, &trial, warnings);
    trial.markers = std::move(input.recording.markers);
  } catch (const Error& error) {
    trial.failure = WithAdvice(error);
  }
  return trial;
}

void MakeNamesUnique(std::vector<Trial>* trials, std::vector<Contender>* contenders) {
  NumberRepeatedNames(trials);
  NumberRepeatedNames(contenders);
}

MmmMotion ReadPostures(const std::string& file, const std::string& preferred) {
  MmmMotionFile content = ReadMmmMotionFile(file);
  std::vector<MmmMotion*> candidates;
  std::vector<std::string> names;
  for (MmmMotion& motion : content.motions) {
    const bool has_postures =
        motion.trajectory.num_frames() > 0 && !motion.trajectory.joint_names.empty();
    if (!has_postures) continue;
    if (motion.name == preferred) return std::move(motion);
    candidates.push_back(&motion);
    names.push_back(motion.name);
  }
  if (candidates.empty()) {
    throw Error(fmt::format("{}: has no motion with joint angles; convert it first", file));
  }
  if (candidates.size() > 1) {
    throw Error(
        fmt::format("{}: has several motions with joint angles ({}); choose one with "
                    "--motion",
                    file, JoinNames(names)));
  }
  return std::move(*candidates.front());
}

PoseTrajectory AlignFrames(const PoseTrajectory& trajectory, const MarkerSequence& markers,
                           const std::string& file) {
  if (std::abs(trajectory.rate - markers.rate()) > kSameRate * markers.rate()) {
    throw Error(fmt::format("{}: has {:g} frames a second, the recording {:g}; they must be equal",
                            file, trajectory.rate, markers.rate()));
  }
  const auto first = std::lround((markers.first_time() - trajectory.first_time) * trajectory.rate);
  if (first < 0 || first + markers.num_frames() > trajectory.num_frames()) {
    throw Error(fmt::format(
        "{}: has postures from {:.3f} s to {:.3f} s, the recording is from {:.3f} s to {:.3f} s; "
        "use --frames for the part that both have",
        file, trajectory.first_time, trajectory.time(trajectory.num_frames() - 1),
        markers.first_time(), markers.time(markers.num_frames() - 1)));
  }
  PoseTrajectory part = trajectory;
  part.first_time = markers.first_time();
  part.postures.assign(trajectory.postures.begin() + first,
                       trajectory.postures.begin() + first + markers.num_frames());
  if (part.standard_deviations.size() > 0) {
    part.standard_deviations =
        Eigen::MatrixXd(trajectory.standard_deviations.middleCols(first, markers.num_frames()));
  }
  for (int k = 0; k < part.num_frames(); ++k) {
    if (part.postures[k].joint_angles.allFinite()) continue;
    throw Error(fmt::format("{}: has no joint angles at {:.3f} s", file, part.time(k)));
  }
  return part;
}

}  // namespace mmm_converter
