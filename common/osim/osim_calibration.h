// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/calibrate/calibration.h"
#include "common/osim/osim_person.h"

namespace mmm_converter {

/// A model of OpenSim as a person's, estimated from recordings.
struct CalibratedOsim {
  ScaledOsim scaled;         ///< its text says how well markers and joints are known
  CalibrationResult result;  ///< its scales are relative to `size`, three of a body ("femur_r x")
  double size = 1;           ///< of the whole person, by the model
  std::shared_ptr<const KinematicModel> model;  ///< of the text, with its markers' deviations
};

/// What is said of the person.
struct OsimPersonFacts {
  std::string name;
  std::optional<double> mass;    ///< [kg], in the model's shares; nothing: as the model has it
  std::optional<double> height;  ///< [m]; only kept
  std::string program;           ///< as FormatSubject
};

/// Estimates the sizes of bodies (FindOsimSizes) along their axes and the places of all markers,
/// `fixed` ones too, as CalibrateSubject does, from the size of the whole model that fits best.
/// document: of `model`, with the markers of a set of its own. reference, joints: of the document,
/// which the assignments of recordings are about.
/// @throws Error as CalibrateSubject, and where the person would have no human proportions.
CalibratedOsim CalibrateOsim(const NamedText& model, const OsimDocument& document,
                             const KinematicModel& reference, const std::vector<int>& joints,
                             const std::vector<CalibrationRecording>& recordings,
                             const OsimPersonFacts& person, const CalibrationOptions& options,
                             Warnings* warnings);

/// What is assumed of a person by the body that a model of OpenSim has.
CalibrationOptions OsimCalibrationOptions();

}  // namespace mmm_converter
