// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/batch/entry_conversion.h"

#include <algorithm>
#include <filesystem>

#include "MMMConverterS2KF/report/conversion_page.h"
#include "MMMConverterS2KF/report/retarget_page.h"
#include "common/support/atomic_file.h"
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

std::map<std::string, FileState> InspectNamedModels(const ConversionReport& report,
                                                    const std::vector<RecordedObject>& objects) {
  std::map<std::string, FileState> models;
  for (const RecordedObject& object : objects) {
    const std::string named = NamedModel(object);
    if (!named.empty()) models[fs::absolute(named).string()] = InspectFile(named);
  }
  const Recording& recording = report.plan.input.recording;
  if (!report.plan.object || !recording.mmm || recording.mmm->model_path.empty()) return models;
  const fs::path folder = fs::path(recording.file).parent_path();
  const std::string named = (folder / recording.mmm->model_path).lexically_normal().string();
  if (report.plan.input.model_file == named) {
    models[recording.mmm->model_path] = InspectFile(named);
  }
  return models;
}

bool AreModelsUnchanged(const BatchEntry& entry, const JournalRecord& record) {
  const fs::path folder = fs::path(entry.request.input.file).parent_path();
  try {
    return std::all_of(record.models.begin(), record.models.end(), [&](const auto& model) {
      return IsUnchanged((folder / model.first).string(), model.second);
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
