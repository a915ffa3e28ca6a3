// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "common/calibrate/osim_person.h"
#include "common/pipeline/input/input.h"
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
  int frames = 0;  ///< of the recording
  Warnings warnings;
};

/// Says in the plan which files the request names.
void NameInputs(const OsimScalingRequest& request, OutputPlan* plan);

/// ScaleOsimPerson with the files of the request. @throws Error
OsimScalingReport RunOsimScaling(const OsimScalingRequest& request);

}  // namespace mmm_converter
