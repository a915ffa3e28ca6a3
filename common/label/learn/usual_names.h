// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "common/label/learn/body_sites.h"

namespace mmm_converter {

/// Where a usual name of a marker (LASI, L.Shoulder, R_5meta, "knee lat right", STRN) says that it
/// is worn: KIT's names, without side, of markers on the parts of the body that it can be on, the
/// likeliest first; none where the name means nothing (m1). Sides are in any spelling, and do not
/// count.
std::vector<std::string_view> UsuallyNear(std::string_view label);

/// What the names of labels say of the sites of a body, labels x sites: 1 that it is worn there, -1
/// elsewhere, 0 nothing. A body without markers of KIT's names has all 0.
Eigen::MatrixXi WhatNamesSay(const std::vector<std::string>& labels, const BodySites& sites);

}  // namespace mmm_converter
