// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/pipeline.h"

#include <fmt/format.h>

#include <utility>

#include "MMMConverterS2KF/motion_output.h"
#include "MMMConverterS2KF/person.h"
#include "common/convert/plugin_loader.h"
#include "common/io/mmm_model.h"
#include "common/io/trajectory_csv.h"
#include "common/support/atomic_file.h"
#include "common/support/data_directory.h"
#include "common/support/error.h"

namespace mmm_converter {
namespace {

constexpr const char* kDefaultConverter = "S2KFConverter";
constexpr const char* kDefaultConfig = "converters/s2kf_default.xml";
constexpr const char* kDefaultModel = "models/mmm.xml";

void TakeFrames(const ConversionRequest& request, ConversionReport* report) {
  MarkerSequence& markers = report->recording.markers;
  const int begin = request.first_frame.value_or(0);
  const int end = std::min(request.end_frame.value_or(markers.num_frames()), markers.num_frames());
  if (begin >= end) {
    throw Error(fmt::format("{}: --frames {}:{} has no frame of the recording's {}, counted from 0",
                            request.input, begin, end, markers.num_frames()));
  }
  report->first_frame = begin;
  if (begin > 0 || end < markers.num_frames()) markers = markers.Slice(begin, end);
}

// The configuration given, or else the shipped one, or that of another converter's defaults.
ConverterConfig ReadConfig(const ConversionRequest& request, const std::string& converter) {
  ConverterConfig config;
  if (!request.config_file.empty()) {
    config = ReadConverterConfig(request.config_file);
  } else if (converter == kDefaultConverter) {
    config = ReadConverterConfig(DataFile(kDefaultConfig));
  } else {
    config.file = "defaults of " + converter;
  }
  if (config.type.empty()) config.type = converter.empty() ? kDefaultConverter : converter;
  if (!converter.empty() && config.type != converter) {
    throw Error(
        fmt::format("{}: is a configuration for {}, not for {}; use --converter {}, or print "
                    "a configuration with print-config {}",
                    config.file, config.type, converter, config.type, converter));
  }
  return config;
}

// Finds out together which converter and which configuration are meant.
LoadedPlugin LoadConverter(const ConversionRequest& request, ConversionReport* report) {
  std::optional<LoadedPlugin> plugin;
  std::string converter = request.converter;
  if (!request.plugin_file.empty()) {
    plugin.emplace(request.plugin_file);
    const std::string name = plugin->factory().name();
    if (!converter.empty() && converter != name) {
      throw Error(
          fmt::format("{}: has the converter {}, not {}", request.plugin_file, name, converter));
    }
    converter = name;
  } else if (converter.empty() && request.config_file.empty()) {
    converter = kDefaultConverter;
  }
  report->config = ReadConfig(request, converter);
  if (!plugin) plugin.emplace(LoadPluginByName(report->config.type));
  report->converter = report->config.type;
  report->plugin_file = plugin->path();
  return std::move(*plugin);
}

void AddWarnings(const std::vector<std::string>& more, ConversionReport* report) {
  report->warnings.insert(report->warnings.end(), more.begin(), more.end());
}

}  // namespace

ConversionReport RunConversion(const ConversionRequest& request,
                               const std::function<void(int, int)>& progress) {
  ConversionReport report;
  report.recording = ReadRecording(request.input, request.recording);
  AddWarnings(report.recording.warnings, &report);
  TakeFrames(request, &report);

  const LoadedPlugin plugin = LoadConverter(request, &report);
  AddWarnings(report.config.warnings, &report);
  report.output_format =
      request.output_format.empty() ? report.config.output_format : request.output_format;
  report.output = ChooseOutput(request, report);

  report.model_file = request.model_file.empty() ? DataFile(kDefaultModel) : request.model_file;
  const MmmModel reference = ReadMmmModel(report.model_file);
  AddWarnings(reference.warnings, &report);
  report.model_name = reference.model.name();
  for (const ModelMarker& marker : reference.model.markers()) {
    report.model_markers.push_back(marker.name);
  }

  const MarkerSequence& markers = report.recording.markers;
  const std::vector<MarkerPair> pairs =
      ResolveMarkerPairs(report.config, markers, reference.model, &report.marker_set);
  report.mapping = ResolveMarkerMapping(pairs, markers, reference.model);
  AddWarnings(report.mapping.warnings, &report);

  const KinematicModel model = ScaleToPerson(request, reference.model, &report);
  const auto converter = plugin.factory().Create(model, report.mapping.assignments, report.config);
  report.result = converter->Convert(markers, model, report.mapping.assignments, [&](int done) {
    if (progress) progress(done, markers.num_frames());
    return true;
  });
  WriteMotion(request, &report);
  if (!request.csv_file.empty()) {
    WriteFileAtomically(request.csv_file, FormatTrajectoryCsv(report.result.trajectory));
  }
  return report;
}

}  // namespace mmm_converter
