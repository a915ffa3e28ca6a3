// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string_view>

#include "common/forces/emg.h"
#include "common/motion/anatomical_angles.h"
#include "common/pipeline/ground_study.h"

namespace mmm_converter {

/// Whether a joint of AnatomicalAngle is a leg's.
bool IsOfLeg(std::string_view joint);

/// Moments and powers of the legs' muscles by mass, as GaitOf has them, a row for each and a column
/// for each frame of TrackedMotion. Nothing: there are no plates, or the model has no mass.
std::optional<AnatomicalAngles> LegMomentsOf(const ConversionReport& report,
                                             const GroundStudy& ground);

/// Fills forces and work of the gait's strides (GaitOf), where there are plates and the model has a
/// mass.
void AddForces(const ConversionReport& report, const GroundStudy& ground, Gait* gait);

/// The same of muscles, whose "EMG" [mV] is over the strides of their side, or of both feet. emg
/// must outlive the gait.
void AddEmg(const Emg& emg, Gait* gait);

}  // namespace mmm_converter
