// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <vector>

#include "common/calibrate/calibration.h"
#include "common/convert/named_markers.h"
#include "common/convert/tracking_setup.h"
#include "common/io/recording/recording.h"
#include "common/judge/verdict.h"
#include "common/model/kinematic_model.h"

namespace mmm_converter {

/// A recording of a person, and how its labels match the model.
struct MatchedRecording {
  const Recording& recording;
  const TrackingSetup& setup;                       ///< on the reference
  std::shared_ptr<const KinematicModel> reference;  ///< not scaled
  const NamedMarkers* names = nullptr;  ///< by which the labels were matched; null: by a set
};

/// What the verdict of a calibration looks at.
struct CalibrationEvidence {
  const CalibrationResult& result;
  PersonScaling person;  ///< what the reference is scaled by; its subject does not count
  std::vector<MatchedRecording> recordings;
};

Verdict JudgeCalibration(const CalibrationEvidence& evidence);

}  // namespace mmm_converter
