// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/conversion/exports.h"

#include <filesystem>

#include "MMMConverterS2KF/conversion/conversion.h"
#include "common/io/tables/mot_writer.h"
#include "common/io/tables/trajectory_csv.h"
#include "common/io/tables/trc_writer.h"
#include "common/support/atomic_file.h"

namespace mmm_converter {
namespace {

TextPieces FormatMarkers(const std::string& file, const ConversionReport& report) {
  const Recording& recording = report.input.recording;
  TrcOutput output;
  output.file_name = std::filesystem::path(file).filename().string();
  output.first_frame = recording.first_frame + report.input.first_frame;
  output.measured = &recording.markers;
  output.model_markers.reserve(report.mapping.assignments.size());
  for (const MarkerAssignment& one : report.mapping.assignments) {
    output.model_markers.push_back({one.label, one.marker});
  }
  output.model = report.model.get();
  output.trajectory = &report.result.trajectory;
  return FormatTrc(output);
}

}  // namespace

void WriteExports(const ExportFiles& files, const ConversionReport& report) {
  const PoseTrajectory& trajectory = report.result.trajectory;
  if (!files.csv.empty()) WriteFileAtomically(files.csv, FormatTrajectoryCsv(trajectory));
  if (!files.trc.empty()) WriteFileAtomically(files.trc, FormatMarkers(files.trc, report));
  if (!files.mot.empty()) {
    const std::string& root = report.model->segments().front().name;
    WriteFileAtomically(files.mot, FormatMot(trajectory, root));
  }
}

}  // namespace mmm_converter
