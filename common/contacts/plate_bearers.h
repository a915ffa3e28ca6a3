// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "common/contacts/contacts.h"
#include "common/motion/slow_feet.h"

namespace mmm_converter {

/// All loads of the plates that tell contacts, and who bears them.
std::vector<PlateLoad> FindBearers(const FootMotion& motion, const SlowFeet& slow,
                                   const RecordedForces& forces);

/// Of a body that a file of forces names: "calcn_r", "right_foot".
Bearer BearerOfName(const std::string& name);

/// Whether p_W lies over the plate's surface, as far as it is known.
bool IsOver(const ForcePlate& plate, const Eigen::Vector3d& p_W);

}  // namespace mmm_converter
