// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/terminal/input_options.h"

#include <fmt/format.h>

#include <limits>

#include "common/support/text.h"

namespace mmm_converter {

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
