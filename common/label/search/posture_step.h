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

/// The same for equations that the caller has completed; damping: as NormalEquations::Solve has it.
/// The posture moves by so much of the step that no angle moves by more than longest [rad].
void StepInsideLimits(double relative, double absolute, double longest, const LabelBody& body,
                      NormalEquations* equations, Posture* posture);

}  // namespace mmm_converter
