// SPDX-License-Identifier: MIT
#include "common/convert/coordinate_tasks.h"

#include <fmt/format.h>

#include <algorithm>

#include "common/model/coordinate_map.h"
#include "common/support/error.h"
#include "common/support/suggestion.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

void CheckIsCoordinate(const KinematicModel& model, const std::string& name) {
  std::vector<std::string> known;
  if (model.coordinates()) {
    for (const ModelCoordinate& one : model.coordinates()->coordinates()) {
      known.push_back(one.name);
    }
  }
  if (std::find(known.begin(), known.end(), name) != known.end()) return;
  const std::string closest = ClosestName(name, known);
  throw Error(fmt::format(
      "a task of inverse kinematics is of coordinate \"{}\", which model {} "
      "does not have{}",
      name, model.name(), closest.empty() ? "" : fmt::format(" (did you mean {}?)", closest)));
}

bool IsHeld(const KinematicModel& model, const std::string& name) {
  const auto& all = model.coordinates()->coordinates();
  const auto one = std::find_if(all.begin(), all.end(),
                                [&](const ModelCoordinate& other) { return other.name == name; });
  return one->root < 0 && one->terms.empty();
}

}  // namespace

std::vector<JointTask> ResolveCoordinateTasks(const std::vector<CoordinateTask>& tasks,
                                              const KinematicModel& model, Warnings* warnings) {
  std::vector<JointTask> resolved;
  std::vector<std::string> unused;
  for (const CoordinateTask& task : tasks) {
    const int joint = model.FindJoint(task.name);
    if (joint >= 0) {
      resolved.push_back({joint, task.value.value_or(model.joint(joint).rest), task.weight});
      continue;
    }
    CheckIsCoordinate(model, task.name);
    if (!IsHeld(model, task.name)) unused.push_back(task.name);
  }
  if (unused.empty()) return resolved;
  Warn(warnings, fmt::format("tasks of coordinates that are part of the root's pose or follow "
                             "others are not used: {}",
                             FirstNames(unused)));
  return resolved;
}

}  // namespace mmm_converter
