// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/batch/batch_outputs.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "common/io/bytes/file_content.h"
#include "common/io/osim/osim_xml.h"
#include "common/io/robot/robot_exports.h"
#include "common/pipeline/exporters.h"
#include "common/support/atomic_file.h"
#include "common/support/error.h"

namespace mmm_converter {
namespace {

namespace fs = std::filesystem;

void MakeFolder(const std::string& path) {
  std::error_code failure;
  fs::create_directories(path, failure);
  if (failure) throw WriteError(path, failure.value());
}

constexpr std::size_t kHeadBytes = 4096;  // of a model: its root is there

bool IsOsimFile(const std::string& path) {
  std::error_code failure;
  return fs::is_regular_file(path, failure) && IsOsimDocument(ReadFileStart(path, kHeadBytes));
}

}  // namespace

std::string MotionPath(const BatchEntry& entry) {
  const bool is_osim = IsOsimFile(entry.request.input.model_file);
  return "motions/" + entry.id + (is_osim ? ".mot" : ".xml");
}

std::string ExportPath(const std::string& format, const std::string& id) {
  std::string ending = format;
  for (const Exporter& exporter : Exporters()) {
    if (format == exporter.name) ending = exporter.ending;
  }
  for (const RobotExporter& exporter : RobotExporters()) {
    if (format == exporter.name) ending = exporter.ending;
  }
  return format + "/" + id + "." + ending;
}
std::string SubjectPath(const std::string& id) { return "subjects/" + id + ".xml"; }
std::string RobotPath(const std::string& id) { return "robots/" + id + ".xml"; }
std::string PagePath(const std::string& id) { return "reports/" + id + ".html"; }

BatchFolder::BatchFolder(const std::string& path) : path_(path) {
  MakeFolder(path);
  RemoveAbandonedFiles(path);
}

std::string BatchFolder::Full(const std::string& relative) const {
  return (fs::path(path_) / relative).string();
}

bool BatchFolder::Has(const std::string& relative) const {
  std::error_code failure;
  return fs::is_regular_file(Full(relative), failure);
}

std::vector<std::string> BatchFolder::OutputsOf(const BatchEntry& entry) {
  std::vector<std::string> outputs = {MotionPath(entry)};
  for (const std::string& format : entry.exports) {
    outputs.push_back(ExportPath(format, entry.id));
  }
  for (const RobotExporter& exporter : RobotExporters()) {
    if (entry.exports.count(exporter.name) == 0) continue;
    const std::vector<std::string> files = FilesOf(exporter, ExportPath(exporter.name, entry.id));
    outputs.insert(outputs.end(), files.begin() + 1, files.end());
  }
  if (!entry.request.robot.file.empty()) outputs.push_back(RobotPath(entry.id));
  if (entry.request.self_calibrate) outputs.push_back(SubjectPath(entry.id));
  return outputs;
}

void BatchFolder::MakeReady(const std::string& relative) {
  const std::string folder = fs::path(Full(relative)).parent_path().string();
  const std::scoped_lock lock(mutex_);
  if (!ready_.insert(folder).second) return;
  try {
    MakeFolder(folder);
  } catch (const WriteError&) {
    ready_.erase(folder);
    throw;
  }
  RemoveAbandonedFiles(folder);
}

std::map<std::string, FileState> BatchFolder::Inspect(
    const std::vector<std::string>& relative) const {
  std::map<std::string, FileState> states;
  for (const std::string& path : relative) states[path] = InspectFile(Full(path));
  return states;
}

bool BatchFolder::IsComplete(const JournalRecord& record,
                             const std::vector<std::string>& relative) const {
  return std::all_of(relative.begin(), relative.end(), [&](const std::string& path) {
    const auto state = record.outputs.find(path);
    return state != record.outputs.end() && Has(path) && IsUnchanged(Full(path), state->second);
  });
}

void BatchFolder::Remove(const std::string& relative) const {
  std::error_code failure;
  fs::remove(Full(relative), failure);
}

void BatchFolder::SetAside(const std::string& relative) const {
  std::error_code failure;
  fs::rename(Full(relative), Full(relative) + kOutdated, failure);
}

}  // namespace mmm_converter
