// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "common/model/kinematic_model.h"
#include "common/support/warnings.h"

namespace mmm_converter {

struct UrdfText {
  std::string xml;
  std::string renamed;  ///< which names were changed; empty: none
};

/// The model as a URDF that ReadUrdfModel reads back with the same kinematics, limits, masses and
/// inertia. A segment becomes a joint of its name that carries the link `<name>_link`; the root,
/// which floats in a URDF by itself, is the link of its name. A marker is a fixed link
/// `<marker>_marker`. What does not move (prismatic nodes too) is fixed; limits of effort and
/// velocity, which a model does not have, are large numbers. Shapes: cylinders from joint to joint,
/// spheres for markers and for what ends a chain. comment: stands at the beginning; may be empty.
/// warnings: what simulators may refuse.
UrdfText FormatUrdf(const KinematicModel& model, const std::string& comment,
                    Warnings* warnings = nullptr);

}  // namespace mmm_converter
