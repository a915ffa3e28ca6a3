// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/input/input.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <utility>

#include "common/support/data_directory.h"
#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

constexpr const char* kDefaultModel = "models/mmm.xml";

void TakeFrames(const InputRequest& request, Input* input) {
  MarkerSequence& markers = input->recording.markers;
  const int begin = request.first_frame.value_or(0);
  const int end = std::min(request.end_frame.value_or(markers.num_frames()), markers.num_frames());
  if (begin >= end) {
    throw Error(fmt::format("{}: --frames {}:{} has no frame of the recording's {}, counted from 0",
                            request.file, begin, request.end_frame.value_or(markers.num_frames()),
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
  plan->Read(request.marker_set);
  plan->Read(request.person.processor_file);
  plan->Read(request.person.subject_file);
}

Input ReadModel(const InputRequest& request, const ReadBefore& read_before, Warnings* warnings) {
  Input input;
  input.model_file = ModelFile(request);
  if (read_before.model.value) {
    input.model = read_before.model.value;
    warnings->Append(read_before.model.warnings);
  } else {
    input.model = std::make_shared<const LoadedModel>(ReadModelFile(input.model_file, warnings));
  }
  input.reference = std::shared_ptr<const KinematicModel>(input.model, &input.model->model);
  return input;
}

WithWarnings<std::shared_ptr<const LoadedModel>> ReadModelOnce(const InputRequest& request) {
  WithWarnings<std::shared_ptr<const LoadedModel>> model;
  model.value =
      std::make_shared<const LoadedModel>(ReadModelFile(ModelFile(request), &model.warnings));
  return model;
}

Input ReadInput(const InputRequest& request, const ReadBefore& read_before, Warnings* warnings) {
  Recording recording;
  const auto& read = read_before.motion.value ? read_before.motion : read_before.recording;
  if (read.value) {
    recording = *read.value;
    warnings->Append(read.warnings);
  } else {
    recording = ReadRecording(request.file, request.reading, warnings);
  }
  Input input = ReadModel(request, read_before, warnings);
  input.recording = std::move(recording);
  TakeFrames(request, &input);
  return input;
}

ConverterChoice TakeConverter(const ConverterRequest& request, const ReadBefore& read_before,
                              Warnings* warnings) {
  if (!read_before.choice.value) return ChooseConverter(request, warnings);
  warnings->Append(read_before.choice.warnings);
  return *read_before.choice.value;
}

void TakeMarkerSet(const InputRequest& request, ConverterConfig* config) {
  if (request.marker_set.empty()) return;
  namespace fs = std::filesystem;
  std::error_code failure;
  const bool is_file =
      fs::exists(request.marker_set, failure) || request.marker_set.ends_with(".xml");
  config->marker_set = is_file ? fs::absolute(request.marker_set).string() : request.marker_set;
  config->marker_pairs.clear();
}

void MatchModel(const InputRequest& request, Input* input, ConverterConfig* config) {
  TakeMarkerSet(request, config);
  if (!input->model->is_reference) config->model_processor = "None";
  const auto set = ReadOwnMarkerSet(*config);
  if (!set || set->places.empty()) return;
  input->reference = std::make_shared<KinematicModel>(PlaceMarkers(*set, *input->model));
}

void ParseFrames(const std::string& text, InputRequest* request) {
  const std::size_t colon = text.find(':');
  const auto part = [&](const std::string& number) -> std::optional<int> {
    if (number.empty()) return std::nullopt;
    const auto value = ParseLong(number);
    if (!value || *value < 0 || *value > std::numeric_limits<int>::max()) {
      throw UsageError(
          fmt::format("frames: \"{}\" is not A:B; for instance 100:400, 100: or :400", text));
    }
    return static_cast<int>(*value);
  };
  if (colon == std::string::npos) part(text + ":");  // throws
  request->first_frame = part(text.substr(0, colon));
  request->end_frame = part(text.substr(colon + 1));
}

const std::vector<OptionGroup>& InputOptions() {
  static const std::vector<OptionGroup> options = {
      {"Recording",
       {{"subject", "NAME", "label prefix of the subject, if a recording has several", ""},
        {"motion", "NAME",
         "MMM files: the motion to convert (convert: or all); other files: the name of the "
         "written motion",
         "motionName"},
        {"frames", "A:B", "frames A to B-1 only, counted from 0; either may be left out", ""},
        {"unit", "mm|cm|m|in", "overrides the unit that the file states", ""},
        {"rate", "HZ", "overrides the frame rate that the file states", ""},
        {"ignore-residuals", "", "C3D files: also use points that the file marks as invalid", ""},
        {"up", "AXIS", "the file's axis that points up: x, y, z, -x, -y or -z", ""}}},
      {"Person and model",
       {{"height", "METRES", "default: from the files, else estimated from the markers", ""},
        {"mass", "KG", "default: from the files, else 70", ""},
        {"hand-length", "METRES", "default: from the files, else by the height", ""},
        {"person", "FILE", "ModelProcessorConfig file with height, mass and hand length",
         "outputModelProcessorConfigFile"},
        {"subject-file", "FILE",
         "calibrated person: height, mass, segment lengths and marker places", ""},
        {"model", "FILE", "MMM model, or a URDF as it is; default: the shipped MMM model",
         "outputModelFile"},
        {"marker-set", "FILE",
         "assigns labels to model markers, and can place these; default: what the "
         "configuration says",
         ""}}}};
  return options;
}

InputRequest MakeInputRequest(const Arguments& arguments, const std::string& file) {
  InputRequest request;
  request.file = file;
  request.reading.unit = arguments.Get("unit");
  request.reading.rate = arguments.GetNumber("rate", "frames a second, e.g. 100");
  request.reading.ignore_residuals = arguments.Has("ignore-residuals");
  if (const auto axis = arguments.Get("up")) request.reading.up_axis = ParseUpAxis(*axis);
  request.reading.subject = arguments.Get("subject").value_or("");
  request.reading.motion = arguments.Get("motion").value_or("");
  if (const auto frames = arguments.Get("frames")) ParseFrames(*frames, &request);
  request.model_file = arguments.Get("model").value_or("");
  request.marker_set = arguments.Get("marker-set").value_or("");
  request.person.processor_file = arguments.Get("person").value_or("");
  request.person.subject_file = arguments.Get("subject-file").value_or("");
  request.person.size.height = arguments.GetNumber("height", "metres, e.g. 1.75");
  request.person.size.mass = arguments.GetNumber("mass", "kilograms, e.g. 70");
  request.person.size.hand_length = arguments.GetNumber("hand-length", "metres, e.g. 0.18");
  return request;
}

}  // namespace mmm_converter
