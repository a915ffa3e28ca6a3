// SPDX-License-Identifier: MIT
#include "common/judge/calibration_verdict.h"

#include <fmt/format.h>

#include "common/judge/coverage.h"
#include "common/judge/evidence.h"
#include "common/support/units.h"

namespace mmm_converter {

Verdict JudgeCalibration(const CalibrationEvidence& evidence) {
  VerdictReasons reasons;
  const CalibrationResult& result = evidence.result;
  bool is_far = reasons.AddBeyond(
      kMeanDistance, result.distance_before,
      fmt::format("before calibration, markers are {:.0f} mm from the model on average, those of "
                  "a person of that height at most {:.0f}",
                  kMillimetres * result.distance_before, kMillimetres * kMeanDistance.check));
  is_far |= reasons.AddBeyond(
      kCalibratedMeanDistance, result.distance_after,
      fmt::format("after calibration, markers are still {:.0f} mm from the model, those of a "
                  "person at most {:.0f}",
                  kMillimetres * result.distance_after,
                  kMillimetres * kCalibratedMeanDistance.check));
  is_far |= JudgeOffsets(result.subject, &reasons);
  for (const MatchedRecording& one : evidence.recordings) {
    JudgeReading(one.recording, &reasons);
    JudgeCoverage(one.setup, LimbsOf(one.setup), &reasons);
    JudgeNoise(one.setup, one.recording.markers, &reasons);
    if (one.names != nullptr) JudgeNames(*one.names, &reasons);
    if (is_far) {
      JudgeSides(one.setup, one.reference, evidence.person, one.recording.markers, &reasons);
    }
  }
  return reasons.Conclude();
}

}  // namespace mmm_converter
