// SPDX-License-Identifier: MIT
#include "common/judge/calibration_verdict.h"

#include <fmt/format.h>

#include <string>

#include "common/support/units.h"

namespace mmm_converter {
namespace {

// Whether the recordings are of one person who moves and wears the same.
void JudgeSources(const CalibrationResult& result, VerdictReasons* reasons) {
  if (result.stands) {
    reasons->Add(Verdict::Level::kCheck,
                 "the person only stands, which does not tell where joints are: angles may be off "
                 "by what their deviations say, the same in all frames; add a recording with "
                 "movement");
  }
  for (const SubjectSource& source : result.subject.sources) {
    if (source.frames > 0) continue;
    reasons->Add(Verdict::Level::kCheck,
                 fmt::format("no frame of {} is taken: it shows too few of the markers, or no "
                             "posture that the others do not have",
                             source.recording));
  }
  for (const MovedMarkers& one : result.moved) {
    reasons->Add(
        Verdict::Level::kCheck,
        fmt::format("{}: {} of {} markers sit more than {:.0f} mm from where the recordings "
                    "together have them; were markers put on anew in between? Calibrate each "
                    "session separately",
                    one.recording, one.moved, one.markers, kMillimetres * one.distance));
  }
}

}  // namespace

Questions AskAboutCalibration(const CalibrationResult& result) {
  Questions asked;
  asked.is_far = kMeanDistance.IsBeyond(result.distance_before) ||
                 kCalibratedMeanDistance.IsBeyond(result.distance_after) ||
                 AreOffsetsFar(result.subject);
  asked.sides = asked.is_far;
  return asked;
}

Verdict JudgeCalibration(const CalibrationEvidence& evidence) {
  VerdictReasons reasons;
  const CalibrationResult& result = evidence.result;
  reasons.AddBeyond(
      kMeanDistance, result.distance_before,
      fmt::format("before calibration, markers are {:.0f} mm from the model on average, those of "
                  "a person of that height at most {:.0f}",
                  kMillimetres * result.distance_before, kMillimetres * kMeanDistance.check));
  reasons.AddBeyond(
      kCalibratedMeanDistance, result.distance_after,
      fmt::format("after calibration, markers are still {:.0f} mm from the model, those of a "
                  "person at most {:.0f}",
                  kMillimetres * result.distance_after,
                  kMillimetres * kCalibratedMeanDistance.check));
  JudgeOffsets(result.subject, &reasons);
  JudgeLandmarks(result.subject, &reasons);
  JudgeProportions(result.subject, &reasons);
  JudgeSources(result, &reasons);
  for (const MatchedRecording& one : evidence.recordings) {
    JudgeReading(one.recording, &reasons);
    JudgeCoverage(one.coverage, &reasons);
    JudgeNoise(one.noise, &reasons);
    if (one.names != nullptr) JudgeNames(*one.names, &reasons);
    JudgeSides(one.sides, &reasons);
  }
  return reasons.Conclude();
}

}  // namespace mmm_converter
