// SPDX-License-Identifier: MIT
#include "common/io/model_file.h"

#include <fmt/format.h>

#include "common/io/bytes/file_content.h"
#include "common/io/mjcf/mjcf_robot.h"
#include "common/io/mmm/mmm_model.h"
#include "common/io/osim/osim_model_reader.h"
#include "common/io/osim/osim_subject.h"
#include "common/io/osim/osim_xml.h"
#include "common/io/urdf/urdf_model_reader.h"
#include "common/io/xml/xml_text.h"
#include "common/support/error.h"

namespace mmm_converter {
namespace {

constexpr std::size_t kHeadBytes = 1 << 16;  // a root stands behind comments of fewer

/// Of the links whose frames their segments have.
std::map<std::string, std::string> SegmentsOfLinks(const Robot& robot) {
  std::map<std::string, std::string> names;
  for (const Robot::Link& link : robot.links) {
    if (!link.X_SL.isApprox(Eigen::Isometry3d::Identity(), 0)) continue;
    names[link.name] = robot.model.segments()[static_cast<std::size_t>(link.segment)].name;
  }
  return names;
}

/// With what its calibration knows of it.
LoadedModel ReadOsim(const std::string& path, const std::string& marker_file, Warnings* warnings) {
  const std::string content = ReadFileContent(path, kMaxOsimBytes);
  KinematicModel model = ParseOsimModel(content, path, marker_file, warnings);
  auto subject = ParseOsimSubject(content, path, model, warnings);
  if (subject) model = FitToSubject(model, *subject);
  return {std::move(model), false, {}, std::move(subject)};
}

}  // namespace

LoadedModel ReadModelFile(const std::string& path, Warnings* warnings,
                          const std::string& marker_file) {
  if (IsOsimDocument(ReadFileStart(path, kHeadBytes))) {
    return ReadOsim(path, marker_file, warnings);
  }
  if (!marker_file.empty()) {
    throw Error(fmt::format("{}: is a set of markers for a model of OpenSim, and {} is none",
                            marker_file, path));
  }
  const std::string content = ReadFileContent(path, kMaxModelBytes);
  if (IsUrdf(content)) {
    UrdfModel urdf = ParseUrdfModel(content, path, warnings);
    return {std::move(urdf.model), false, std::move(urdf.segment_of_link)};
  }
  if (IsMjcf(content)) {
    Robot robot = ReadMjcf(path, warnings);
    std::map<std::string, std::string> segment_of_link = SegmentsOfLinks(robot);
    return {std::move(robot.model), false, std::move(segment_of_link)};
  }
  return {ParseMmmModel(content, path, warnings), true, {}};
}

}  // namespace mmm_converter
