// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "common/calibrate/calibration.h"
#include "common/calibrate/osim_person.h"

namespace mmm_converter {

/// A model of OpenSim as a person's, estimated from recordings.
struct CalibratedOsim {
  ScaledOsim scaled;
  CalibrationResult result;  ///< its scales are relative to `size`; models have body names
  double size = 1;           ///< of the whole person, by the model
};

/// Estimates the sizes of bodies (FindOsimSizes) and the places of all markers, `fixed` ones too,
/// as CalibrateSubject does, from the size of the whole model that fits best. mass: of the person
/// [kg], in the model's shares; nothing: as the model has it. document: of `model`, with the
/// markers of a set of its own. reference, joints: of the document, which the assignments of
/// recordings are about.
/// @throws Error as CalibrateSubject, and where the person would have no human proportions.
CalibratedOsim CalibrateOsim(const NamedText& model, const OsimDocument& document,
                             const KinematicModel& reference, const std::vector<int>& joints,
                             const std::vector<CalibrationRecording>& recordings,
                             std::optional<double> mass, const CalibrationOptions& options,
                             Warnings* warnings);

/// What is assumed of a person by the body that a model of OpenSim has.
CalibrationOptions OsimCalibrationOptions();

}  // namespace mmm_converter
