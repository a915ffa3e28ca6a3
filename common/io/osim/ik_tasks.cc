// SPDX-License-Identifier: MIT
#include "common/io/osim/ik_tasks.h"

#include <fmt/format.h>

#include "common/io/osim/osim_values.h"
#include "common/io/osim/osim_xml.h"
#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

constexpr double kLeastWeight = 1e-9;  // below it a task asks for nothing

CoordinateTask ReadCoordinateTask(const XmlElement& task, double weight, Diagnostics* diagnostics) {
  CoordinateTask of{OsimName(task), weight, {}};
  const std::string_view type = OsimText(task, "value_type");
  if (EqualIgnoringCase(type, "manual_value")) {
    of.value = ReadOsimNumber(task, "value", 0, diagnostics);
  } else if (EqualIgnoringCase(type, "from_file")) {
    diagnostics->AddError(task.line, fmt::format("task of coordinate '{}': values from a file are "
                                                 "not read; use default_value or manual_value",
                                                 of.name));
  }
  return of;
}

/// As the root, in OpenSim's root, or in the set-up of one of its tools; null: there is none.
const XmlElement* FindTaskSet(const XmlElement& element, int depth = 0) {
  constexpr int kDeepest = 3;  // OpenSimDocument, ScaleTool, MarkerPlacer
  if (element.Is("IKTaskSet")) return &element;
  for (const XmlElement& child : element.children) {
    const XmlElement* set = depth < kDeepest ? FindTaskSet(child, depth + 1) : nullptr;
    if (set != nullptr) return set;
  }
  return nullptr;
}

}  // namespace

IkTasks ReadIkTasks(const XmlElement& set, Diagnostics* diagnostics) {
  IkTasks tasks;
  const XmlElement* objects = set.FindChild("objects");
  if (objects == nullptr) return tasks;
  for (const XmlElement& task : objects->children) {
    const bool is_applied = ReadOsimFlag(task, "apply", true, diagnostics);
    const double weight = ReadOsimNumber(task, "weight", 1, diagnostics);
    if (weight < 0) {
      diagnostics->AddError(task.line,
                            fmt::format("task '{}': a weight can't be negative", OsimName(task)));
    }
    if (!is_applied || weight < kLeastWeight) continue;
    if (task.Is("IKMarkerTask")) tasks.markers.push_back({OsimName(task), weight});
    if (task.Is("IKCoordinateTask")) {
      tasks.coordinates.push_back(ReadCoordinateTask(task, weight, diagnostics));
    }
  }
  return tasks;
}

IkTasks ParseIkTasks(std::string_view content, const std::string& file) {
  Diagnostics diagnostics(file);
  const XmlElement root = ParseXml(FirstElement(content), file);
  const XmlElement* set = FindTaskSet(root);
  if (set == nullptr) {
    throw Error(
        fmt::format("{}:{}: <{}> holds no <IKTaskSet>", file, root.line, root.name.substr(0, 40)));
  }
  IkTasks tasks = ReadIkTasks(*set, &diagnostics);
  diagnostics.ThrowIfErrors();
  return tasks;
}

}  // namespace mmm_converter
