// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <iostream>

#include "MMMConverterS2KF/command_line.h"
#include "MMMConverterS2KF/commands/commands.h"
#include "MMMConverterS2KF/log.h"
#include "MMMConverterS2KF/pipeline.h"
#include "MMMConverterS2KF/progress.h"
#include "MMMConverterS2KF/summary.h"
#include "common/support/atomic_file.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

const std::vector<OptionGroup> kOptions = {
    {"Files",
     {{"output,o", "FILE", "the motion; default: INPUT without its ending + _mmm.xml",
       "outputMotion"},
      {"format", "2.0|1.0", "of the motion; default: what the configuration says, 2.0", ""},
      {"csv", "FILE", "also write postures and their standard deviations as CSV", ""},
      {"summary", "FILE", "write a summary as JSON", ""}}},
    {"Recording",
     {{"subject", "NAME", "label prefix to take where a recording has several subjects", ""},
      {"motion", "NAME",
       "of an MMM file: the motion to convert; else: the name of the motion that is written",
       "motionName"},
      {"frames", "A:B", "frames A to B-1 only, counted from 0; either may be left out", ""},
      {"unit", "mm|cm|m|in", "instead of what the file says", ""},
      {"rate", "HZ", "instead of what the file says", ""},
      {"ignore-residuals", "", "of a C3D file: take also points that it marks as invalid", ""},
      {"up", "AXIS", "the file's axis that points up: x, y, z, -x, -y or -z", ""}}},
    {"Person and model",
     {{"height", "METRES", "default: from the files, else estimated from the markers", ""},
      {"mass", "KG", "default: from the files, else 70", ""},
      {"hand-length", "METRES", "default: from the files, else by the height", ""},
      {"person", "FILE", "ModelProcessorConfig file with height, mass and hand length",
       "outputModelProcessorConfigFile"},
      {"model", "FILE", "reference model; default: the shipped MMM model", "outputModelFile"},
      {"model-path", "PATH", "what the motion says of where its model is; default: relative to it",
       ""}}},
    {"Converter",
     {{"config,c", "FILE", "configuration; default: the shipped one of the S2KFConverter",
       "converterConfigFile"},
      {"converter", "NAME", "default: what the configuration says, else S2KFConverter", ""},
      {"plugin", "FILE", "take the converter from this plugin file", ""}}},
    {"General",
     {{"log", "LEVEL", "off, error, warning, info or debug; default: info", ""},
      {"help,h", "", "print this help", ""}}}};

constexpr const char* kUsage = R"(MMMConverterS2KF convert INPUT [options]
Converts the markers of INPUT (C3D, TRC, or an MMM motion with markers) into an MMM motion.
Of an MMM 2.0 file all other motions are kept; -o may be INPUT then.

{}MMMMotionConverter's options --inputMotion, --motionName, --converterConfigFile, --outputModelFile,
--outputModelProcessorConfigFile and --outputMotion stand for INPUT, --motion, -c, --model, --person
and -o.

Examples
  MMMConverterS2KF convert walk.c3d --height 1.75
  MMMConverterS2KF convert walk.c3d --height 1.75 --mass 70 -o walk.xml --summary walk.json
  MMMConverterS2KF convert recording.xml --motion 1723 -o recording.xml
  MMMConverterS2KF convert walk.c3d --frames 100:400 -c my.xml --format 1.0
)";

void ParseFrames(const std::string& text, ConversionRequest* request) {
  const std::size_t colon = text.find(':');
  const auto part = [&](const std::string& number) -> std::optional<int> {
    if (number.empty()) return std::nullopt;
    const auto value = ParseLong(number);
    if (!value || *value < 0 || *value > std::numeric_limits<int>::max()) {
      throw UsageError(
          fmt::format("--frames: \"{}\" is not A:B; for instance 100:400, 100: or :400", text));
    }
    return static_cast<int>(*value);
  };
  if (colon == std::string::npos) part(text + ":");  // throws
  request->first_frame = part(text.substr(0, colon));
  request->end_frame = part(text.substr(colon + 1));
}

std::string ChooseInput(const Arguments& arguments) {
  const auto legacy = arguments.Get("inputMotion");
  if (legacy && arguments.positional()) {
    throw UsageError(fmt::format("convert: one input only, but there are \"{}\" and \"{}\"",
                                 *arguments.positional(), *legacy));
  }
  if (legacy) return *legacy;
  if (arguments.positional()) return *arguments.positional();
  throw UsageError(
      "convert: which recording? For instance: MMMConverterS2KF convert walk.c3d "
      "--height 1.75");
}

ConversionRequest MakeRequest(const Arguments& arguments) {
  ConversionRequest request;
  request.input = ChooseInput(arguments);
  request.output = arguments.Get("output").value_or("");
  request.output_format = arguments.Get("format").value_or("");
  request.csv_file = arguments.Get("csv").value_or("");
  if (arguments.Has("format") && request.output_format != "2.0" && request.output_format != "1.0") {
    throw UsageError(
        fmt::format("--format: \"{}\" is not allowed; use 2.0 or 1.0", request.output_format));
  }
  request.recording.unit = arguments.Get("unit");
  request.recording.rate = arguments.GetNumber("rate", "frames a second, e.g. 100");
  request.recording.ignore_residuals = arguments.Has("ignore-residuals");
  if (const auto axis = arguments.Get("up")) request.recording.up_axis = ParseUpAxis(*axis);
  request.recording.subject = arguments.Get("subject").value_or("");
  request.recording.motion = arguments.Get("motion").value_or("");
  request.motion_name = request.recording.motion;
  if (const auto frames = arguments.Get("frames")) ParseFrames(*frames, &request);
  request.model_file = arguments.Get("model").value_or("");
  request.model_path = arguments.Get("model-path").value_or("");
  request.processor_file = arguments.Get("person").value_or("");
  request.height = arguments.GetNumber("height", "metres, e.g. 1.75");
  request.mass = arguments.GetNumber("mass", "kilograms, e.g. 70");
  request.hand_length = arguments.GetNumber("hand-length", "metres, e.g. 0.18");
  request.config_file = arguments.Get("config").value_or("");
  request.converter = arguments.Get("converter").value_or("");
  request.plugin_file = arguments.Get("plugin").value_or("");
  return request;
}

}  // namespace

void RunConvert(const std::vector<std::string>& words) {
  std::vector<OptionGroup> options = kOptions;
  options.push_back({"", {{"inputMotion", "FILE", "", ""}}});
  const Arguments arguments = ParseArguments("convert", options, words);
  if (arguments.Has("help")) {
    std::cout << fmt::format(kUsage, FormatOptions(kOptions));
    return;
  }
  StartLog(arguments.Get("log").value_or("info"));
  const ConversionRequest request = MakeRequest(arguments);
  ProgressBar bar;
  const ConversionReport report =
      RunConversion(request, [&](int done, int all) { bar.Show(done, all); });
  bar.Clear();
  for (const std::string& warning : report.warnings) LogWarning(warning);
  if (const auto file = arguments.Get("summary")) {
    WriteFileAtomically(*file, FormatSummaryJson(report));
  }
  std::cout << FormatSummary(report);
}

}  // namespace mmm_converter
