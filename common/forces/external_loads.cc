// SPDX-License-Identifier: MIT
#include "common/forces/external_loads.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string_view>

#include "common/forces/plate_checks.h"
#include "common/io/bytes/file_content.h"
#include "common/io/tables/storage_table.h"
#include "common/io/xml/xml_document.h"
#include "common/io/xml/xml_text.h"
#include "common/math/rotation.h"
#include "common/model/body_bounds.h"
#include "common/motion/marker_sequence.h"
#include "common/support/error.h"
#include "common/support/error_of_file.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

constexpr double kUneven = 0.5;  // of a step: how far a time may be from an even grid

/// Columns of x, y and z.
using Triple = std::array<Eigen::Index, 3>;

/// Where the columns of a force stand, and what it acts on.
struct LoadColumns {
  std::string name, body;
  Triple force = {};
  std::optional<Triple> point, torque;
};

Eigen::Index FindColumn(const StorageTable& table, const std::string& name) {
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    if (table.columns[i] == name) return static_cast<Eigen::Index>(i);
  }
  return -1;
}

/// The columns NAMEx, NAMEy and NAMEz, wherever they stand; nothing: there is no NAMEx.
std::optional<Triple> FindTriple(const StorageTable& table, const std::string& name,
                                 const std::string& file) {
  Triple found;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string column = name + "xyz"[i];
    found[i] = FindColumn(table, column);
    if (found[i] >= 0) continue;
    if (i == 0) return std::nullopt;
    throw Error(fmt::format("{}: has a column {}x, but none {}; x, y and z are expected", file,
                            name, column));
  }
  return found;
}

/// Of the only three columns that begin so, which end with x, y and z in any order; nothing: the
/// identifier is none.
std::optional<Triple> ColumnsOf(const StorageTable& table, const std::string& identifier,
                                const std::string& file, int line) {
  if (identifier.empty() || EqualIgnoringCase(identifier, "Unassigned")) return std::nullopt;
  Triple found = {-1, -1, -1};
  int count = 0;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    if (!table.columns[i].starts_with(identifier)) continue;
    ++count;
    const std::size_t axis = std::string_view("xyz123").find(ToLower(table.columns[i]).back());
    if (axis != std::string_view::npos) found[axis % 3] = static_cast<Eigen::Index>(i);
  }
  if (count == 3 && *std::min_element(found.begin(), found.end()) >= 0) return found;
  throw Error(
      fmt::format("{}:{}: \"{}\" begins the names of {} columns of the table; three are "
                  "expected, which end with x, y and z",
                  file, line, identifier, count));
}

std::string Replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  return at == std::string::npos ? std::string() : text.replace(at, what.size(), by);
}

/// What the names of the columns tell.
std::vector<LoadColumns> LoadsByNames(const StorageTable& table, const std::string& file) {
  std::vector<LoadColumns> loads;
  for (const std::string& column : table.columns) {
    if (!column.ends_with("vx")) continue;
    const std::string prefix = column.substr(0, column.size() - 2);
    LoadColumns load;
    load.name = column.substr(0, column.size() - 1);
    load.force = *FindTriple(table, prefix + "v", file);
    load.point = FindTriple(table, prefix + "p", file);
    for (const std::string& torque :
         {Replaced(prefix, "force", "torque"), Replaced(prefix, "force", "moment"),
          Replaced(prefix, "force", "moment") + "m", prefix + "m", prefix + "t"}) {
      if (!load.torque && !torque.empty()) load.torque = FindTriple(table, torque, file);
    }
    loads.push_back(std::move(load));
  }
  return loads;
}

bool Says(const XmlElement& element, const char* child, const char* text) {
  const XmlElement* found = element.FindChild(child);
  return found != nullptr && EqualIgnoringCase(found->text, text);
}

std::string TextOf(const XmlElement& element, const char* child) {
  const XmlElement* found = element.FindChild(child);
  return found == nullptr ? "" : found->text;
}

const XmlElement* FindLoads(const XmlElement& root) {
  if (root.Is("ExternalLoads")) return &root;
  return root.FindChild("ExternalLoads");
}

std::vector<LoadColumns> LoadsByXml(const XmlElement& loads, const StorageTable& table,
                                    const std::string& file, Warnings* warnings) {
  std::vector<LoadColumns> found;
  const XmlElement* objects = loads.FindChild("objects");
  if (objects == nullptr) return found;
  for (const XmlElement* one : objects->FindChildren("ExternalForce")) {
    const std::string* name = one->FindAttribute("name");
    const std::string called = name == nullptr ? "ExternalForce" : *name;
    if (Says(*one, "appliesForce", "false") || Says(*one, "isDisabled", "true")) continue;
    const std::string frame = TextOf(*one, "force_expressed_in_body");
    const std::string point_frame = TextOf(*one, "point_expressed_in_body");
    if ((!frame.empty() && frame != "ground") ||
        (!point_frame.empty() && point_frame != "ground")) {
      Warn(warnings, fmt::format("{}:{}: {} is in the axes of {}; only forces and points in those "
                                 "of the ground are read, it is left out",
                                 file, one->line, called, frame == "ground" ? point_frame : frame));
      continue;
    }
    LoadColumns load;
    load.name = called;
    load.body = TextOf(*one, "applied_to_body");
    const auto columns = [&](const char* identifier) {
      return ColumnsOf(table, TextOf(*one, identifier), file, one->line);
    };
    const auto force = columns("force_identifier");
    if (!force) {
      throw Error(fmt::format("{}:{}: {} has no <force_identifier>", file, one->line, called));
    }
    load.force = *force;
    load.point = columns("point_identifier");
    load.torque = columns("torque_identifier");
    found.push_back(std::move(load));
  }
  return found;
}

/// Sets rate and first time.
void ReadTimes(const StorageTable& table, const std::string& file, RecordedForces* forces) {
  const auto times = table.rows.col(0);
  const Eigen::Index last = times.size() - 1;
  const double step = last > 0 ? (times[last] - times[0]) / static_cast<double>(last) : 0;
  if (!(step > 0)) {
    throw Error(file + ": needs rows of at least two moments, in the order of time");
  }
  for (Eigen::Index k = 0; k <= last; ++k) {
    if (std::abs(times[k] - (times[0] + static_cast<double>(k) * step)) < kUneven * step) continue;
    throw Error(fmt::format("{}: the times are not even: {:g} s in row {}", file, times[k], k + 1));
  }
  if (!IsFrameRate(1 / step)) {
    throw Error(
        fmt::format("{}: its rows are {:g} s apart; forces have from 1 to 100000 rows a "
                    "second",
                    file, step));
  }
  forces->rate = 1 / step;
  forces->first_time = times[0];
}

PlateForces ForcesOf(const LoadColumns& load, const StorageTable& table, const Eigen::Vector3d& up,
                     const std::string& file) {
  const auto columns = [&](const Triple& at) {
    Eigen::Matrix3Xd rows(3, table.rows.rows());
    for (Eigen::Index i = 0; i < 3; ++i) rows.row(i) = table.rows.col(at[i]).transpose();
    if ((rows.array().isNaN() || rows.array().abs() <= kLargestForce).all()) return rows;
    throw Error(
        fmt::format("{}: {} has numbers above {:g}; newtons, metres and newton metres are "
                    "expected",
                    file, load.name, kLargestForce));
  };
  PlateForces forces;
  forces.applied_to = load.body.empty() ? load.name : load.body;
  forces.force = columns(load.force);
  const Eigen::Index samples = forces.force.cols();
  forces.plate.has_moments = load.point.has_value();
  forces.plate.corners.setConstant(kNaN);
  forces.plate.R_WP = RotationBetween(-Eigen::Vector3d::UnitZ(), up);
  forces.cop = Eigen::Matrix3Xd::Constant(3, samples, kNaN);
  if (load.point) forces.cop = columns(*load.point);
  forces.free_moment = Eigen::Matrix3Xd::Zero(3, samples);
  if (load.torque) forces.free_moment = columns(*load.torque);
  forces.moment = forces.free_moment;
  for (Eigen::Index k = 0; k < samples; ++k) {
    const Eigen::Vector3d cop = forces.cop.col(k);
    const Eigen::Vector3d force = forces.force.col(k);
    forces.moment.col(k) += cop.cross(force);
  }
  return forces;
}

}  // namespace

RecordedForces ReadExternalLoads(const std::string& path, const Eigen::Vector3d& up,
                                 Warnings* warnings) {
  namespace fs = std::filesystem;
  const WarningContext context(warnings, path);
  std::string content = ReadFileContent(path);
  XmlElement root;
  const XmlElement* loads = nullptr;
  std::string file = path;
  if (!RootName(content).empty()) {
    root = ParseXml(content, path);
    loads = FindLoads(root);
    if (loads == nullptr) throw Error(path + ": has no ExternalLoads");
    const std::string data = TextOf(*loads, "datafile");
    if (data.empty()) throw Error(path + ": ExternalLoads names no datafile");
    file = (fs::path(path).parent_path() / data).string();
    content = NamedBy(path, [&] { return ReadFileContent(file); });
  }
  const auto parse = [&] { return ParseStorage(content, file); };
  const StorageTable table = loads != nullptr ? NamedBy(path, parse) : parse();
  RecordedForces forces;
  ReadTimes(table, file, &forces);
  const std::vector<LoadColumns> columns =
      loads != nullptr ? LoadsByXml(*loads, table, path, warnings) : LoadsByNames(table, file);
  if (columns.empty()) {
    throw Error(
        fmt::format("{}: has no force: columns such as ground_force_1_vx, ..._vy, ..._vz", path));
  }
  for (const LoadColumns& load : columns) {
    PlateForces one = ForcesOf(load, table, up, file);
    one.plate.number = static_cast<int>(forces.plates.size()) + 1;
    JudgeLoads(forces.rate, &one, warnings);
    if (!load.point) {
      Warn(warnings,
           fmt::format("{} has no point; its force is read, but no centre of pressure", load.name));
    }
    forces.plates.push_back(std::move(one));
  }
  return forces;
}

}  // namespace mmm_converter
