// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "common/calibrate/body_fit.h"
#include "common/calibrate/body_kinematics.h"
#include "common/convert/motion_converter.h"
#include "common/model/subject.h"

namespace mmm_converter {

/// The joints whose constant error has a deviation of a degree and more, the largest first.
/// Partners explain half of its variance and more each: a marker by its three coordinates together.
std::vector<JointDoubt> FindJointDoubts(const BodyKinematics& kinematics, const BodyFitResult& fit);

/// A sentence for each joint whose error is worth a warning; empty: none.
std::vector<std::string> DescribeDoubts(const std::vector<JointDoubt>& doubts);

/// The angles of a motion that was tracked with the subject are not better known than the body is:
/// deviations that are less than its joint's become that, covariances follow.
void WidenDeviations(const Subject& subject, ConversionResult* result);

}  // namespace mmm_converter
