// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "common/fit/normal_equations.h"
#include "common/label/search/label_body.h"
#include "common/model/posture.h"

namespace mmm_converter {

/// A damped step (Levenberg-Marquardt), inside the joint limits and not longer than 0.6 rad, of the
/// posture that `equations` was placed at towards targets, 3 x markers [m], NaN: none; natural
/// angles count a little (MatchCosts). noise [m]: by marker. Farther than robust_distance [m] a
/// target only pulls (Huber).
void StepTowards(const Eigen::Ref<const Eigen::Matrix3Xd>& targets, const Eigen::VectorXd& noise,
                 double robust_distance, const LabelBody& body, NormalEquations* equations,
                 Posture* posture);

}  // namespace mmm_converter
