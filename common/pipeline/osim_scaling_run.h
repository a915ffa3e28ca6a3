// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "common/judge/verdict.h"
#include "common/osim/osim_calibration.h"
#include "common/osim/osim_person.h"
#include "common/pipeline/input/input.h"
#include "common/pipeline/person_calibration.h"
#include "common/support/output_plan.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// A model of OpenSim, a recording of the person, and OpenSim's set-up that says how one becomes
/// the other's.
struct OsimScalingRequest {
  InputRequest input;
  std::string setup_file;
};

struct OsimScalingReport {
  ScaledOsim scaled;
  int frames = 0;                           ///< of the recording
  std::optional<CalibrationResult> result;  ///< of RunOsimCalibration
  std::optional<Verdict> verdict;           ///< of that
  double size = 1;  ///< of the whole person, which the result's scales are of
  std::vector<CalibrationInput> recordings;     ///< of RunOsimCalibration
  std::shared_ptr<const KinematicModel> model;  ///< of that, with its markers' deviations
  Warnings warnings;
};

/// Says in the plan which files the request names.
void NameInputs(const OsimScalingRequest& request, OutputPlan* plan);

/// ScaleOsimPerson with the files of the request. @throws Error
OsimScalingReport RunOsimScaling(const OsimScalingRequest& request);

/// CalibrateOsim with the recordings of the request, whose model is one of OpenSim; configuration
/// and progress as RunCalibration. @throws Error
OsimScalingReport RunOsimCalibration(const CalibrationRequest& request,
                                     WithWarnings<ConverterConfig> configuration,
                                     const std::function<void(int, int)>& progress);

/// Whether the file of the request's model is one of OpenSim. @throws Error
bool IsOsimModel(const InputRequest& request);

}  // namespace mmm_converter
