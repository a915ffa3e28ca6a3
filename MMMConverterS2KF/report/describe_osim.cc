// SPDX-License-Identifier: MIT
// What is in a model of OpenSim.

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "MMMConverterS2KF/report/describe.h"
#include "MMMConverterS2KF/report/json.h"
#include "common/io/bytes/file_content.h"
#include "common/io/osim/osim_model_reader.h"
#include "common/io/osim/tool_setup.h"
#include "common/model/coordinate_map.h"
#include "common/pipeline/input/osim_setup.h"

namespace mmm_converter {
namespace {

const char* UnitOf(const ModelCoordinate& one) {
  return one.kind == ModelCoordinate::Kind::kTurn    ? "rad"
         : one.kind == ModelCoordinate::Kind::kShift ? "m"
                                                     : "rad or m";
}

/// What a tracker makes of a coordinate.
std::string RoleOf(const ModelCoordinate& one) {
  if (one.root >= 0) return "of the floating root";
  if (one.is_locked) return fmt::format("locked at {:.6g}", one.constant);
  if (one.terms.empty()) return fmt::format("constant at {:.6g}", one.constant);
  if (one.terms.size() == 1 && one.terms.front().joint == one.name) {
    return one.is_clamped ? "tracked within its range" : "tracked";
  }
  std::string leaders;
  for (const ModelCoordinate::Term& term : one.terms) {
    leaders += (leaders.empty() ? "" : " and ") + term.joint;
  }
  return "follows " + leaders;
}

std::map<std::string, int> CountTypes(const OsimDocument& document) {
  std::map<std::string, int> types;
  for (const OsimJoint& joint : document.joints) ++types[joint.type];
  return types;
}

std::string TextOf(const std::string& file, const OsimDocument& document,
                   const KinematicModel& model) {
  std::string types;
  for (const auto& [type, count] : CountTypes(document)) {
    types += fmt::format("{}{} {}", types.empty() ? "" : ", ", count, type);
  }
  std::string text = fmt::format(
      "{}: OpenSim model {}, version {}\nbodies     {} with {:.6g} kg; the root {}\n"
      "joints     {} ({})\nforces     {}, {} of them muscles, which are not used\n"
      "coordinates {}\n",
      file, document.name, document.version, document.bodies.size() - 1, model.total_mass(),
      model.is_root_fixed() ? "is the ground" : "floats", document.joints.size(), types,
      document.num_forces, document.num_muscles, document.coordinates.size());
  for (const ModelCoordinate& one : model.coordinates()->coordinates()) {
    text += fmt::format("  {:<24} {:9.6g} to {:9.6g} {:<8} {}\n", one.name, one.lower, one.upper,
                        UnitOf(one), RoleOf(one));
  }
  text += fmt::format("markers    {}\n", model.markers().size());
  for (const ModelMarker& marker : model.markers()) {
    text += fmt::format("  {:<16} on {:<16} at {:7.4f} {:7.4f} {:7.4f} m\n", marker.name,
                        model.segments()[marker.segment].name, marker.p_SM.x(), marker.p_SM.y(),
                        marker.p_SM.z());
  }
  return text;
}

Json JsonOf(const std::string& file, const OsimDocument& document, const KinematicModel& model) {
  Json json = {{"kind", "osim"},
               {"file", file},
               {"name", document.name},
               {"version", document.version},
               {"bodies", document.bodies.size() - 1},
               {"mass_kg", model.total_mass()},
               {"root", model.is_root_fixed() ? "ground" : "floats"},
               {"joints", CountTypes(document)},
               {"forces", document.num_forces},
               {"muscles", document.num_muscles},
               {"coordinates", Json::array()},
               {"markers", Json::array()}};
  for (const ModelCoordinate& one : model.coordinates()->coordinates()) {
    json["coordinates"].push_back({{"name", one.name},
                                   {"unit", UnitOf(one)},
                                   {"lower", Number(one.lower, 9)},
                                   {"upper", Number(one.upper, 9)},
                                   {"default", one.rest},
                                   {"clamped", one.is_clamped},
                                   {"locked", one.is_locked},
                                   {"role", RoleOf(one)}});
  }
  for (const ModelMarker& marker : model.markers()) {
    const Eigen::Vector3d& p = marker.p_SM;
    json["markers"].push_back({{"name", marker.name},
                               {"body", model.segments()[marker.segment].name},
                               {"offset_m", {p.x(), p.y(), p.z()}}});
  }
  return json;
}

Description DescribeSetup(const std::string& file, const OsimToolSetup& setup) {
  const std::string times =
      setup.time_range
          ? fmt::format("{:.6g} to {:.6g} s", (*setup.time_range)[0], (*setup.time_range)[1])
          : "all";
  const std::string weights = setup.has_tasks ? "in the set-up" : setup.tasks_file;
  const std::pair<const char*, std::string> rows[] = {{"model", setup.model_file},
                                                      {"markers", setup.marker_set_file},
                                                      {"recording", setup.marker_file},
                                                      {"motion", setup.coordinates_file},
                                                      {"loads", setup.loads_file},
                                                      {"weights", weights},
                                                      {"times", times}};
  std::string text = fmt::format("{}: set-up of OpenSim's {}\n", file, setup.tool);
  Json json = {{"kind", "osim_setup"}, {"file", file}, {"tool", setup.tool}};
  for (const auto& [key, value] : rows) {
    if (!value.empty()) text += fmt::format("{:<10} {}\n", key, value);
    json[key] = TextOrNull(value);
  }
  if (!setup.marker_file.empty()) {
    text += fmt::format("convert    MMMConverterS2KF convert --setup {}\n", file);
  }
  return {text, FormatJson(json), {}};
}

}  // namespace

Description DescribeOsim(const FileStart& file, const ReadRecordingOptions&) {
  const std::string content = ReadFileContent(file.path, kMaxOsimBytes);
  if (IsOsimToolSetup(content)) {
    return DescribeSetup(file.path, ParseOsimToolSetup(content, file.path));
  }
  Warnings warnings;
  Diagnostics diagnostics(file.path, &warnings);
  const OsimDocument document = ParseOsimDocument(content, "", &diagnostics, &warnings);
  const KinematicModel model = MakeOsimModel(document, &diagnostics);
  Json json = JsonOf(file.path, document, model);
  json["warnings"] = warnings.texts();
  const std::string weights = FindWeightsBeside(file.path, model);
  json["weights"] = TextOrNull(weights);
  std::string text = TextOf(file.path, document, model);
  if (!weights.empty()) {
    text += fmt::format("weights    of its markers are in {}, for --marker-set\n", weights);
  }
  return {text, FormatJson(json), warnings};
}

}  // namespace mmm_converter
