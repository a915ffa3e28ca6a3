// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "common/calibrate/calibration.h"
#include "common/convert/exchanged_sides.h"
#include "common/convert/named_markers.h"
#include "common/io/recording/recording.h"
#include "common/judge/evidence.h"
#include "common/judge/verdict.h"
#include "common/study/coverage.h"

namespace mmm_converter {

/// A recording of a person whose labels are matched with the model.
struct MatchedRecording {
  const Recording& recording;
  const NamedMarkers* names = nullptr;  ///< by which the labels were matched; null: by a set
  Coverage coverage = {};
  double noise = 0;                          ///< MeasureMarkerNoise [m]
  std::optional<ExchangedSides> sides = {};  ///< nothing: none, or not asked for
};

/// What the verdict of a calibration looks at.
struct CalibrationEvidence {
  const CalibrationResult& result;
  std::vector<MatchedRecording> recordings;
};

/// Of each recording.
Questions AskAboutCalibration(const CalibrationResult& result);

Verdict JudgeCalibration(const CalibrationEvidence& evidence);

}  // namespace mmm_converter
