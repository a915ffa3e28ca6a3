// SPDX-License-Identifier: MIT
#include "common/io/osim/ik_tasks.h"

#include <fmt/format.h>

#include "common/io/osim/osim_values.h"
#include "common/io/osim/osim_xml.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

constexpr double kLeastWeight = 1e-9;  // below it a task asks for nothing

IkTasks::OfCoordinate ReadCoordinateTask(const XmlElement& task, double weight,
                                         Diagnostics* diagnostics) {
  IkTasks::OfCoordinate of{OsimName(task), weight, {}};
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
  IkTasks tasks = ReadIkTasks(ParseOsimPart(content, file, "IKTaskSet"), &diagnostics);
  diagnostics.ThrowIfErrors();
  return tasks;
}

}  // namespace mmm_converter
