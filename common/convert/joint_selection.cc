// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "common/convert/converter_config.h"
#include "common/model/kinematic_model.h"
#include "common/model/kit_joints.h"
#include "common/support/diagnostics.h"
#include "common/support/error.h"
#include "common/support/suggestion.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

// These came with the later models.
constexpr std::array kFeet = {"LFx_joint", "LMrot_joint", "RFx_joint", "RMrot_joint"};

std::vector<std::string> JointNames(const KinematicModel& model) {
  std::vector<std::string> names;
  names.reserve(model.num_joints());
  for (int j = 0; j < model.num_joints(); ++j) names.push_back(model.joint(j).name);
  return names;
}

std::string Located(const ConverterConfig& config, int line) {
  return line > 0 ? fmt::format("{}:{}", config.file, line) : config.file;
}

std::string DescribeUnknownJoint(const KinematicModel& model, const std::string& name) {
  const int segment = model.FindSegment(name);
  if (segment >= 0) {
    return fmt::format("\"{}\" does not turn in model {} (it is fixed or prismatic)", name,
                       model.name());
  }
  const std::string closest = ClosestName(name, JointNames(model));
  return fmt::format("model {} has no joint \"{}\"{}", model.name(), name,
                     closest.empty() ? "; `MMMConverterS2KF info MODEL` lists them"
                                     : fmt::format(" (did you mean {}?)", closest));
}

std::vector<int> ResolveList(const ConverterConfig& config, const KinematicModel& model) {
  std::vector<int> joints;
  Diagnostics diagnostics(config.file);
  for (const ConfigJoint& joint : config.joints) {
    const int index = model.FindJoint(joint.name);
    if (index < 0) {
      diagnostics.AddError(joint.line,
                           diagnostics.is_full() ? "" : DescribeUnknownJoint(model, joint.name));
    }
    joints.push_back(index);
  }
  diagnostics.ThrowIfErrors();
  return joints;
}

// Joints of KIT's list that the model has.
std::vector<int> KnownJoints(const KinematicModel& model, bool with_feet) {
  std::vector<int> joints;
  for (const std::string& name : KitJointNames()) {
    const bool is_foot = std::find(kFeet.begin(), kFeet.end(), name) != kFeet.end();
    const int index = model.FindJoint(name);
    if (index >= 0 && (with_feet || !is_foot)) joints.push_back(index);
  }
  return joints;
}

std::vector<int> AllJoints(const KinematicModel& model) {
  std::vector<int> joints(model.num_joints());
  for (int j = 0; j < model.num_joints(); ++j) joints[j] = j;
  return joints;
}

}  // namespace

std::vector<int> ResolveJoints(const ConverterConfig& config, const KinematicModel& model) {
  if (!config.joints.empty()) return ResolveList(config, model);
  const std::string& set = config.joint_set;
  std::vector<int> joints;
  if (set == "mmm44" || set == "mmm40") joints = KnownJoints(model, set == "mmm44");
  if (set == "auto") joints = KnownJoints(model, true);
  if (set == "all" || (set == "auto" && joints.empty())) joints = AllJoints(model);
  const auto node_set = model.node_sets().find(set);
  if (joints.empty() && node_set != model.node_sets().end()) {
    for (const std::string& node : node_set->second) {
      if (const int index = model.FindJoint(node); index >= 0) joints.push_back(index);
    }
  }
  if (joints.empty() && set != "auto") {
    std::vector<std::string> sets = {"auto", "mmm44", "mmm40", "all"};
    for (const auto& [name, unused] : model.node_sets()) sets.push_back(name);
    throw Error(fmt::format("{}: <Joints>: set=\"{}\" has no joint of model {}; use {}",
                            Located(config, config.joint_set_line), set, model.name(),
                            JoinNames(sets)));
  }
  return joints;
}

}  // namespace mmm_converter
