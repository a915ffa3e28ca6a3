// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "common/kinetics/joint_forces.h"
#include "common/support/text_pieces.h"

namespace mmm_converter {

// Must outlive the texts.

/// As OpenSim's inverse dynamics writes it (.sto): NAME_moment [N m], NAME_force [N]; nan: not
/// known. From the first to the last frame with a value.
TextPieces FormatJointForcesSto(const JointForces& found);

/// time_s, NAME_Nm or NAME_N, their standard deviations sd_... where they are estimated, then
/// residual_fx_N to residual_mz_Nm. Empty: not known.
TextPieces FormatJointForcesCsv(const JointForces& found);

/// The residuals with the published limits, and the largest and smallest moments of the legs'
/// joints, for each kg of the body.
std::string FormatJointForcesJson(const JointForces& found);

/// What the residuals say, in a sentence.
std::string SentenceOf(const Residuals& residuals, const JointForces& found);

}  // namespace mmm_converter
