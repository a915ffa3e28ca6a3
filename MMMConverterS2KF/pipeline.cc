// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/pipeline.h"

#include "MMMConverterS2KF/motion_output.h"
#include "common/io/trajectory_csv.h"
#include "common/support/atomic_file.h"

namespace mmm_converter {
namespace {

void AddWarnings(const std::vector<std::string>& more, ConversionReport* report) {
  report->warnings.insert(report->warnings.end(), more.begin(), more.end());
}

}  // namespace

ConversionReport RunConversion(const ConversionRequest& request,
                               const std::function<void(int, int)>& progress) {
  ConversionReport report;
  report.input = ReadInput(request.input);
  AddWarnings(report.input.warnings, &report);
  report.converter = ChooseConverter(request.converter);
  const ConverterConfig& config = report.converter.config;
  AddWarnings(config.warnings, &report);
  report.output_format =
      request.output_format.empty() ? config.output_format : request.output_format;
  report.output = ChooseOutput(request, report);

  const KinematicModel& reference = *report.input.reference;
  const MarkerSequence& markers = report.input.recording.markers;
  const std::vector<MarkerPair> pairs =
      ResolveMarkerPairs(config, markers, reference, &report.marker_set);
  report.mapping = ResolveMarkerMapping(pairs, markers, reference);
  AddWarnings(report.mapping.warnings, &report);
  const std::vector<MarkerAssignment>& assignments = report.mapping.assignments;
  report.model = std::make_shared<KinematicModel>(
      ScaleToPerson(request.input.person, reference, report.input.recording, config, assignments,
                    &report.person, &report.warnings));

  const auto converter =
      report.converter.plugin->factory().Create(*report.model, assignments, config);
  report.result = converter->Convert(markers, *report.model, assignments, [&](int done) {
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
