// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "common/label/learn/learn_frames.h"

namespace mmm_converter {

/// Why labels are no markers, by label; empty: nothing says so. Joint centres, virtual markers,
/// angles and forces that are stored as points: by their names (LHipAngles, RKJC, CentreOfMass), by
/// standing still or far away while the others move, by being where another one is, or by being an
/// exact function of two or three others whose own distances vary as skin moves. Of markers that
/// are rigid to the last digit, as made ones are, nothing can be told.
std::vector<std::string> WhyNoMarkers(const std::vector<std::string>& labels,
                                      const std::vector<LearnFrame>& frames);

}  // namespace mmm_converter
