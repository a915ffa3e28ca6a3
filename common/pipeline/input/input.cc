// SPDX-License-Identifier: MIT
#include "common/pipeline/input/input.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <utility>

#include "common/calibrate/joint_doubts.h"
#include "common/pipeline/input/osim_setup.h"
#include "common/support/advice.h"
#include "common/support/data_directory.h"
#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

constexpr const char* kDefaultModel = "models/mmm.xml";

/// Of frames whose time is in the range, to half a frame: begin and end.
std::array<int, 2> FramesIn(const std::array<double, 2>& times, const InputRequest& request,
                            const MarkerSequence& markers) {
  const double half = 0.5 / markers.rate();
  int begin = 0, end = markers.num_frames();
  while (begin < end && markers.time(begin) < times[0] - half) ++begin;
  while (end > begin && markers.time(end - 1) > times[1] + half) --end;
  if (begin < end) return {begin, end};
  throw Error(fmt::format("{}: the time range of {}, {:.6g} to {:.6g} s, has no frame of the "
                          "recording, which is from {:.6g} to {:.6g} s",
                          request.file, request.setup_file, times[0], times[1], markers.time(0),
                          markers.time(markers.num_frames() - 1)),
              Remedy::kFrames);
}

void KeepFrames(const InputRequest& request, Input* input) {
  MarkerSequence& markers = input->recording.markers;
  int begin = request.first_frame.value_or(0);
  int end = std::min(request.end_frame.value_or(markers.num_frames()), markers.num_frames());
  if (request.time_range && markers.num_frames() > 0) {
    const auto frames = FramesIn(*request.time_range, request, markers);
    begin = frames[0];
    end = frames[1];
  }
  if (begin >= end) {
    throw Error(fmt::format("{}: {} {}:{} has no frame of the recording's {}, counted from 0",
                            request.file, OptionText("frames"), begin,
                            request.end_frame.value_or(markers.num_frames()),
                            markers.num_frames()));
  }
  input->first_frame = begin;
  if (begin > 0 || end < markers.num_frames()) markers = markers.Slice(begin, end);
}

}  // namespace

std::string ModelFile(const InputRequest& request) {
  return request.model_file.empty() ? DataFile(kDefaultModel) : request.model_file;
}

void NameInputs(const InputRequest& request, OutputPlan* plan) {
  plan->Read(request.file);
  plan->Read(ModelFile(request));
  plan->Read(request.setup_file);
  plan->Read(request.marker_set);
  if (!request.marker_set.empty()) plan->Read(FileWithTasks(request.marker_set));
  plan->Read(request.marker_file);
  plan->Read(request.forces_file);
  plan->Read(request.reading.smpl_model);
  plan->Read(request.person.processor_file);
  plan->Read(request.person.subject_file);
  plan->Read(request.patient.normal_file);
}

Input ReadModel(const InputRequest& request, const ReadBefore& read_before, Warnings* warnings) {
  Input input;
  input.model_file = ModelFile(request);
  if (read_before.model.value) {
    input.model = read_before.model.value;
    warnings->Append(read_before.model.warnings);
  } else {
    input.model = std::make_shared<const LoadedModel>(
        ReadModelFile(input.model_file, warnings, request.marker_file));
  }
  input.reference = std::shared_ptr<const KinematicModel>(input.model, &input.model->model);
  return input;
}

void CheckIsNoOsim(const Input& input, const std::string& what) {
  if (!input.model->model.coordinates()) return;
  throw Error(
      fmt::format("{}: {} can't be done with a model of OpenSim; its recordings can be "
                  "converted and compared",
                  input.model_file, what));
}

WithWarnings<std::shared_ptr<const LoadedModel>> ReadModelOnce(const InputRequest& request) {
  WithWarnings<std::shared_ptr<const LoadedModel>> model;
  model.value = std::make_shared<const LoadedModel>(
      ReadModelFile(ModelFile(request), &model.warnings, request.marker_file));
  return model;
}

Input ReadInput(const InputRequest& request, const ReadBefore& read_before, Warnings* warnings) {
  Recording recording;
  const auto& read = read_before.motion.value ? read_before.motion : request.recording;
  if (read.value) {
    recording = *read.value;
    warnings->Append(read.warnings);
  } else {
    recording = ReadRecording(request.file, request.reading, warnings);
  }
  Input input = ReadModel(request, read_before, warnings);
  input.recording = std::move(recording);
  input.forces_file = request.forces_file;
  input.smpl_model = request.reading.smpl_model;
  KeepFrames(request, &input);
  return input;
}

void UseModelsSubject(const Input& input, Person* person, Warnings* warnings) {
  if (person->subject || !input.model->subject) return;
  person->subject = input.model->subject;
  person->subject_file = input.model_file;
  const std::vector<std::string> doubts = DescribeDoubts(person->subject->joints);
  if (doubts.empty()) return;
  Warn(warnings, fmt::format("{}: its calibration leaves open what is zero for {}; deviations "
                             "say it, and a calibration with more movement tells it",
                             input.model_file, FirstNames(doubts, 6)));
}

ConverterChoice ChosenConverter(const ConverterRequest& request, const ReadBefore& read_before,
                                Warnings* warnings) {
  if (!read_before.choice.value) return ChooseConverter(request, warnings);
  if (warnings != nullptr) warnings->Append(read_before.choice.warnings);
  return *read_before.choice.value;
}

void UseMarkerSet(const InputRequest& request, ConverterConfig* config) {
  if (request.marker_set.empty()) return;
  namespace fs = std::filesystem;
  std::error_code failure;
  const bool is_file =
      fs::exists(request.marker_set, failure) || request.marker_set.ends_with(".xml");
  config->marker_set =
      is_file ? fs::absolute(FileWithTasks(request.marker_set)).string() : request.marker_set;
  config->marker_pairs.clear();
  config->marker_set_line = 0;  // it is not the configuration's
}

void MatchModel(const InputRequest& request, Input* input, ConverterConfig* config) {
  UseMarkerSet(request, config);
  if (!input->model->is_reference) config->model_processor = "None";
  const auto set = ReadOwnMarkerSet(*config);
  if (!set || set->places.empty()) return;
  input->reference = std::make_shared<KinematicModel>(PlaceMarkers(*set, *input->model));
}

}  // namespace mmm_converter
