// SPDX-License-Identifier: MIT
// The formats of parts that the core reads: the one place where both meet.
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/convert/marker_set.h"
#include "common/io/bytes/file_content.h"
#include "common/io/mjcf/mjcf_robot.h"
#include "common/io/mmm/mmm_model.h"
#include "common/io/model_file.h"
#include "common/io/osim/ik_tasks.h"
#include "common/io/osim/osim_model_reader.h"
#include "common/io/osim/osim_subject.h"
#include "common/io/osim/osim_xml.h"
#include "common/io/osim/tool_setup.h"
#include "common/io/urdf/urdf_model_reader.h"

namespace mmm_converter {
namespace {

constexpr std::size_t kHeadBytes = 1 << 16;  // a root stands behind comments of fewer

/// With what its calibration knows of it.
std::optional<LoadedModel> ReadOsim(const std::string& path, const std::string& marker_file,
                                    Warnings* warnings) {
  if (!IsOsimDocument(ReadFileStart(path, kHeadBytes))) return std::nullopt;
  const std::string content = ReadFileContent(path, kMaxOsimBytes);
  KinematicModel model = ParseOsimModel(content, path, marker_file, warnings);
  auto subject = ParseOsimSubject(content, path, model, warnings);
  if (subject) model = FitToSubject(model, *subject);
  return LoadedModel{std::move(model), false, {}, std::move(subject)};
}

/// Of the links whose frames their segments have.
std::map<std::string, std::string> SegmentsOfLinks(const Robot& robot) {
  std::map<std::string, std::string> names;
  for (const Robot::Link& link : robot.links) {
    if (!link.X_SL.isApprox(Eigen::Isometry3d::Identity(), 0)) continue;
    names[link.name] = robot.model.segments()[static_cast<std::size_t>(link.segment)].name;
  }
  return names;
}

std::optional<LoadedModel> ReadRobot(const std::string& path, const std::string& marker_file,
                                     Warnings* warnings) {
  if (!marker_file.empty()) return std::nullopt;
  const std::string content = ReadFileContent(path, kMaxModelBytes);
  if (IsUrdf(content)) {
    UrdfModel urdf = ParseUrdfModel(content, path, warnings);
    return LoadedModel{std::move(urdf.model), false, std::move(urdf.segment_of_link)};
  }
  if (!IsMjcf(content)) return std::nullopt;
  Robot robot = ReadMjcf(path, warnings);
  std::map<std::string, std::string> segment_of_link = SegmentsOfLinks(robot);
  return LoadedModel{std::move(robot.model), false, std::move(segment_of_link)};
}

/// An IKTaskSet: the markers that have a task, under their own names, a weight being
/// 1 / noiseScale^2, and the coordinates that have one.
std::optional<MarkerSet> ParseTasks(std::string_view content, const std::string& path) {
  if (!IsOsimPart(content, "IKTaskSet") && !IsOsimToolSetup(content)) return std::nullopt;
  IkTasks tasks = ParseIkTasks(content, path);
  MarkerSet set;
  set.file = path;
  set.name = std::filesystem::path(path).stem().string();
  for (const IkTasks::OfMarker& one : tasks.markers) {
    set.pairs.push_back({one.name, one.name, 1 / std::sqrt(one.weight)});
  }
  set.coordinate_tasks = std::move(tasks.coordinates);
  return set;
}

}  // namespace

const std::vector<ModelReader*>& PartModelReaders() {
  static const std::vector<ModelReader*> kReaders = {ReadOsim, ReadRobot};
  return kReaders;
}

const std::vector<MarkerSetParser*>& PartMarkerSetParsers() {
  static const std::vector<MarkerSetParser*> kParsers = {ParseTasks};
  return kParsers;
}

}  // namespace mmm_converter
