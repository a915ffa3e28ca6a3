// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "common/contacts/contacts.h"

namespace mmm_converter {

/// Times in which each foot is low and slow, as frames [begin, end) that need not be whole; what
/// the recording cuts begins at 0 or ends at the number of frames less one.
struct SlowFoot {
  double begin = 0, end = 0;
};
using SlowFeet = std::array<std::vector<SlowFoot>, 2>;

SlowFeet FindSlowFeet(const FootMotion& motion);

/// All loads of the plates that tell contacts, and who bears them.
std::vector<PlateLoad> FindBearers(const FootMotion& motion, const SlowFeet& slow,
                                   const RecordedForces& forces);

/// Of a body that a file of forces names: "calcn_r", "right_foot".
Bearer BearerOfName(const std::string& name);

/// Whether p_W lies over the plate's surface, as far as it is known.
bool IsOver(const ForcePlate& plate, const Eigen::Vector3d& p_W);

}  // namespace mmm_converter
