// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/batch/entry_conversion.h"

#include <algorithm>
#include <filesystem>

#include "MMMConverterS2KF/report/conversion_page.h"
#include "MMMConverterS2KF/report/retarget_page.h"
#include "common/support/atomic_file.h"
#include "common/support/data_directory.h"
#include "common/support/error.h"

namespace mmm_converter {

namespace fs = std::filesystem;

ConversionRequest RequestOf(const BatchEntry& entry, const BatchFolder& folder) {
  ConversionRequest request = entry.request;
  request.output = folder.Full(MotionPath(entry));
  for (const Exporter& exporter : Exporters()) {
    if (entry.exports.count(exporter.name) == 0) continue;
    request.exports[exporter.name] = folder.Full(ExportPath(exporter.name, entry.id));
  }
  if (request.self_calibrate) request.subject_output = folder.Full(SubjectPath(entry.id));
  request.builds_models = false;  // several recordings of an object need the same one
  return request;
}

ConversionReport ConvertEntry(const ConversionRequest& request, const ReadBefore& read_before,
                              const std::function<bool()>& goes_on) {
  const auto progress = [&](int, int) { return goes_on(); };
  return RunConversion(request, LabelFirst(request, read_before, progress), progress);
}

std::optional<RetargetReport> RetargetEntry(const BatchEntry& entry, const BatchFolder& folder,
                                            const ConversionReport& report) {
  if (entry.request.robot.file.empty()) return std::nullopt;
  if (report.plan.object) {
    throw Error(entry.request.input.file +
                ": shows an object, whose motion is not brought to a robot (robot=\"\")");
  }
  RetargetRequest request = RequestFor(entry.request, report);
  request.conversion.output = folder.Full(RobotPath(entry.id));
  RetargetReport robot = RunRetargeting(request, {});
  for (const RobotExporter& exporter : RobotExporters()) {
    if (entry.exports.count(exporter.name) == 0) continue;
    CheckRobotExport(exporter, entry.request.robot, robot);
  }
  return robot;
}

void WriteRobotOutputs(const BatchEntry& entry, const BatchFolder& folder, RetargetReport* robot) {
  WriteRobotMotion(robot);
  for (const RobotExporter& exporter : RobotExporters()) {
    if (entry.exports.count(exporter.name) == 0) continue;
    WriteRobotExport(exporter, folder.Full(ExportPath(exporter.name, entry.id)),
                     entry.request.robot, robot);
  }
}

namespace {

fs::path FolderOf(const BatchEntry& entry) {
  std::error_code failure;
  const fs::path recording = fs::weakly_canonical(entry.request.input.file, failure);
  return recording.parent_path();
}

}  // namespace

std::map<std::string, FileState> InspectInputs(const BatchEntry& entry,
                                               const std::set<std::string>& opened,
                                               const std::set<std::string>& fingerprinted) {
  const fs::path folder = FolderOf(entry);
  std::error_code failure;
  const std::string shipped = fs::weakly_canonical(DataDirectory(), failure).string() + "/";
  std::map<std::string, FileState> inputs;
  for (const std::string& file : opened) {
    const bool is_known = fingerprinted.count(file) > 0 || file.starts_with(shipped) ||
                          fs::equivalent(file, entry.request.input.file, failure);
    if (!is_known) inputs[fs::path(file).lexically_relative(folder).string()] = InspectFile(file);
  }
  return inputs;
}

bool AreInputsUnchanged(const BatchEntry& entry, const JournalRecord& record) {
  const fs::path folder = FolderOf(entry);
  try {
    return std::all_of(record.inputs.begin(), record.inputs.end(), [&](const auto& input) {
      return IsUnchanged((folder / input.first).string(), input.second);
    });
  } catch (const Error&) {
    return false;
  }
}

void WritePage(const BatchEntry& entry, const ConversionReport& report,
               const std::optional<RetargetReport>& robot, BatchFolder* folder) {
  folder->MakeReady(PagePath(entry.id));
  WriteFileAtomically(folder->Full(PagePath(entry.id)),
                      robot ? FormatRetargetPage(*robot) : FormatConversionPage({&report}));
}

}  // namespace mmm_converter
