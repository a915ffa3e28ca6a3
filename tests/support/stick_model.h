// SPDX-License-Identifier: MIT
#pragma once

#include "common/model/kinematic_model.h"

namespace mmm_converter::testing {

/// A root and two links of 0.5 m above each other with a hinge each, four markers, and a node that
/// does not turn: small enough to know every answer by heart.
inline KinematicModel StickModel() {
  ModelDescription description;
  description.name = "stick";
  const auto add = [&](const char* name, int parent, double z, JointType type) {
    Segment segment;
    segment.name = name;
    segment.parent = parent;
    segment.X_PF.translation().z() = z;
    segment.type = type;
    segment.axis = Eigen::Vector3d::UnitX();
    segment.lower = type == JointType::kRevolute ? -1 : 0;
    segment.upper = type == JointType::kRevolute ? 1 : 0;
    segment.mass = 1;
    description.segments.push_back(segment);
  };
  add("root", -1, 0, JointType::kFixed);
  add("knee", 0, 0.5, JointType::kRevolute);
  add("hip", 1, 0.5, JointType::kRevolute);
  add("plate", 2, 0.1, JointType::kFixed);
  description.markers = {{"MARKER_A", 0, {0.1, 0, 0}},
                         {"MARKER_B", 0, {0, 0.1, 0}},
                         {"MARKER_C", 1, {0, 0, 0.2}},
                         {"MARKER_D", 2, {0, 0, 0.3}}};
  description.node_sets["Upper"] = {"hip", "plate"};
  return KinematicModel(description);
}

}  // namespace mmm_converter::testing
