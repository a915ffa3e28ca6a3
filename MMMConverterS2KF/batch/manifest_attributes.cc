// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/batch/manifest_attributes.h"

#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <sstream>

#include "MMMConverterS2KF/terminal/input_options.h"
#include "common/model/model_scaling.h"
#include "common/motion/marker_sequence.h"
#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

namespace fs = std::filesystem;

constexpr double kMillimetre = 1e-3;

std::string FileIn(const std::string& folder, const std::string& file) {
  return file.empty() ? "" : (fs::path(folder) / file).lexically_normal().string();
}

std::string TakeNumber(const std::string& value, double unit, double least, double most,
                       std::optional<double>* number) {
  const auto parsed = ParseDouble(value);
  const bool is_allowed = parsed && *parsed * unit >= least && *parsed * unit <= most;
  if (is_allowed) *number = *parsed * unit;
  return is_allowed ? ""
                    : fmt::format("give a number from {:g} to {:g}", least / unit, most / unit);
}

std::string TakeBoolean(const std::string& value, bool* flag) {
  *flag = value == "true";
  return *flag || value == "false" ? "" : "use true or false";
}

std::string TakeLabel(const std::string& value, ConversionRequest* request) {
  request->label_hints.repair = value == "repair";
  request->label = value == "true" || value == "repair";
  return request->label || value == "false" ? "" : "use true, repair or false";
}

std::string TakeExport(const std::string& format, const std::string& value, BatchEntry* entry) {
  bool is_wanted = false;
  std::string expected = TakeBoolean(value, &is_wanted);
  if (is_wanted) {
    entry->exports.insert(format);
  } else {
    entry->exports.erase(format);
  }
  return expected;
}

// What a parser of command line options says of its value.
template <typename Parse>
std::string TakeParsed(Parse parse) {
  try {
    parse();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

// A file beside the manifest, or the name of something shipped.
std::string FindShipped(const std::string& value, const std::string& folder) {
  const std::string file = FileIn(folder, value);
  const bool is_name = value.find('/') == std::string::npos && !value.ends_with(".xml");
  std::error_code failure;
  return is_name && !fs::exists(file, failure) ? value : file;
}

using Value = const std::string&;
using Settings = BatchEntry*;

std::vector<ManifestAttribute> MakeAttributes() {
  std::vector<ManifestAttribute> attributes = {
      {"config", "the converter's configuration: a file, or the name of a shipped one",
       [](Value v, Value folder, Settings s) {
         s->request.converter.config = FindShipped(v, folder);
         return std::string();
       }},
      {"plugin", "the converter's plugin file, where it is none of the installed",
       [](Value v, Value folder, Settings s) {
         s->request.converter.plugin_file = FileIn(folder, v);
         return std::string();
       }},
      {"model", "reference model; the shipped MMM model without it",
       [](Value v, Value folder, Settings s) {
         s->request.input.model_file = FileIn(folder, v);
         return std::string();
       }},
      {"markerSet",
       "which labels stand for which markers, and where these are: a file, or a shipped set",
       [](Value v, Value folder, Settings s) {
         s->request.input.marker_set = FindShipped(v, folder);
         return std::string();
       }},
      {"modelPath", "what motions say of where their model is; relative to them without it",
       [](Value v, Value, Settings s) {
         s->request.model_path = v;
         return std::string();
       }},
      {"height_m", "height; from the recording's file or estimated without it",
       [](Value v, Value, Settings s) {
         return TakeNumber(v, 1, kLeastHeight, kLargestHeight,
                           &s->request.input.person.size.height);
       }},
      {"mass_kg", "mass; from the recording's file or 70 without it",
       [](Value v, Value, Settings s) {
         return TakeNumber(v, 1, kLeastMass, kLargestMass, &s->request.input.person.size.mass);
       }},
      {"handLength_mm", "length of the hand; by the height without it",
       [](Value v, Value, Settings s) {
         return TakeNumber(v, kMillimetre, kLeastHandLength, kLargestHandLength,
                           &s->request.input.person.size.hand_length);
       }},
      {"person", "ModelProcessorConfig file with height, mass and hand length",
       [](Value v, Value folder, Settings s) {
         s->request.input.person.processor_file = FileIn(folder, v);
         return std::string();
       }},
      {"subjectFile", "who the person is, from calibrate",
       [](Value v, Value folder, Settings s) {
         s->request.input.person.subject_file = FileIn(folder, v);
         return std::string();
       }},
      {"selfCalibrate", "true: estimate the person from each recording itself",
       [](Value v, Value, Settings s) { return TakeBoolean(v, &s->request.self_calibrate); }},
      {"label", "true: find the names of points without labels first; repair: correct wrong labels",
       [](Value v, Value, Settings s) { return TakeLabel(v, &s->request); }},
      {"labelLike", "with label: a labelled recording of the person with these markers",
       [](Value v, Value folder, Settings s) {
         s->request.label_hints.like = FileIn(folder, v);
         return std::string();
       }},
      {"labelAndSubjectFiles",
       "with label: who else is there, from calibrate: files, with ; between them",
       [](Value v, Value folder, Settings s) {
         s->request.label_hints.other_persons.clear();
         std::istringstream files(v);
         for (std::string file; std::getline(files, file, ';');) {
           const std::string name(Trim(file));
           if (!name.empty()) s->request.label_hints.other_persons.push_back(FileIn(folder, name));
         }
         return std::string();
       }},
      {"labelObjectModels", "with label: folder with the models of rigid objects that may be there",
       [](Value v, Value folder, Settings s) {
         s->request.label_hints.object_models = FileIn(folder, v);
         return std::string();
       }},
      {"subject", "label prefix to take where a recording has several subjects",
       [](Value v, Value, Settings s) {
         s->request.input.reading.subject = v;
         return std::string();
       }},
      {"motion", "of an MMM file: the motion to convert; else the name of the motion written",
       [](Value v, Value, Settings s) {
         s->request.input.reading.motion = v;
         s->request.motion_name = v;
         return std::string();
       }},
      {"frames", "A:B, frames A to B-1 only, counted from 0; either may be left out",
       [](Value v, Value, Settings s) {
         return TakeParsed([&] { ParseFrames(v, &s->request.input); });
       }},
      {"unit", "mm, cm, m or in, instead of what the file says",
       [](Value v, Value, Settings s) -> std::string {
         s->request.input.reading.unit = v;
         return v == "mm" || v == "cm" || v == "m" || v == "in" ? "" : "use mm, cm, m or in";
       }},
      {"rate_hz", "frames a second, instead of what the file says",
       [](Value v, Value, Settings s) {
         return TakeNumber(v, 1, kLowestRate, kHighestRate, &s->request.input.reading.rate);
       }},
      {"up", "the file's axis that points up: x, y, z, -x, -y or -z",
       [](Value v, Value, Settings s) {
         return TakeParsed([&] { s->request.input.reading.up_axis = ParseUpAxis(v); });
       }},
      {"ignoreResiduals", "true: of a C3D file take also points that it marks as invalid",
       [](Value v, Value, Settings s) {
         return TakeBoolean(v, &s->request.input.reading.ignore_residuals);
       }},
      {"format", "2.0 or 1.0, of the motions; what the configuration says without it",
       [](Value v, Value, Settings s) -> std::string {
         s->request.output_format = v;
         return v == "2.0" || v == "1.0" ? "" : "use 2.0 or 1.0";
       }}};
  for (const Exporter& exporter : Exporters()) {
    attributes.push_back({exporter.name, fmt::format("true: write {} too", exporter.what),
                          [name = std::string(exporter.name)](Value v, Value, Settings s) {
                            return TakeExport(name, v, s);
                          }});
  }
  return attributes;
}

}  // namespace

const std::vector<ManifestAttribute>& ManifestAttributes() {
  static const std::vector<ManifestAttribute> attributes = MakeAttributes();
  return attributes;
}

}  // namespace mmm_converter
