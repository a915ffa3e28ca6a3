// SPDX-License-Identifier: MIT
#include "common/judge/label_verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/support/text.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

using Level = Verdict::Level;

// Share of the names that no point has: right 0, fewer markers than the set has up to 0.4.
constexpr Limit kNamesNotFound = {0.4, 0.6};
// Mean of one minus the probability of a name: right at most 0.005; by another person's subject
// file 0.02 to 0.15.
constexpr Limit kUnsure = {0.08, 0.4};

const Limit& MeanLimit(const LabelEvidence& evidence) {
  return evidence.is_calibrated ? kCalibratedMeanDistance : kMeanDistance;
}

const Limit& PercentileLimit(const LabelEvidence& evidence) {
  return evidence.is_calibrated ? kCalibratedPercentile : kPercentile;
}

void JudgeFit(const LabelEvidence& evidence, VerdictReasons* reasons) {
  const LabelFit& fit = evidence.fit;
  const char* whose = evidence.is_calibrated ? "the subject: another person's, or put on anew since"
                                             : "the model of that height";
  reasons->AddBeyond(MeanLimit(evidence), fit.mean_distance,
                     fmt::format("the named points are {:.0f} mm from the markers of {}",
                                 kMillimetres * fit.mean_distance, whose));
  reasons->AddBeyond(PercentileLimit(evidence), fit.p95_distance,
                     fmt::format("5 % of the named points are more than {:.0f} mm from the markers "
                                 "of {}",
                                 kMillimetres * fit.p95_distance, whose));
  reasons->AddBeyond(
      kMarkerMean, fit.farthest,
      fmt::format("{} of the names {} on average more than {:.0f} mm from where the "
                  "body can have {}: {}; are the points this person's?",
                  fit.far_names.size(), fit.far_names.size() == 1 ? "is" : "are",
                  kMillimetres * kMarkerMean.check, fit.far_names.size() == 1 ? "it" : "them",
                  FirstNames(fit.far_names, 6)));
  if (evidence.names != nullptr) JudgeNames(*evidence.names, reasons);
  JudgePlaces(evidence.labels.places, reasons);
  JudgeSides(evidence.labels.sides, reasons);
  if (evidence.height <= 0 || fit.told_height <= 0) return;
  const double ratio = fit.told_height / evidence.height;
  reasons->AddBeyond(kHeight, std::abs(ratio - 1),
                     fmt::format("the points are those of a person of {:.2f} m, {:.2f} times the "
                                 "height of {:.2f} m; are the height and the file's unit right?",
                                 fit.told_height, ratio, evidence.height));
}

}  // namespace

Questions AskAboutLabels(const LabelEvidence& evidence) {
  Questions asked;
  asked.is_far = MeanLimit(evidence).IsBeyond(evidence.fit.mean_distance) ||
                 PercentileLimit(evidence).IsBeyond(evidence.fit.p95_distance);
  asked.places = !evidence.is_calibrated && evidence.fit.far_names.empty();
  asked.sides = asked.is_far || evidence.names != nullptr;
  return asked;
}

Verdict JudgeLabels(const LabelEvidence& evidence) {
  VerdictReasons reasons;
  JudgeReading(evidence.recording, &reasons);
  const NamingFigures& naming = evidence.naming;
  const std::vector<std::string>& missing = naming.missing;
  const int names = naming.num_names, spare = naming.spare_points;
  const std::string not_found =
      fmt::format("{} of {} names {} not found ({})", missing.size(), names,
                  missing.size() == 1 ? "was" : "were", FirstNames(missing));
  const bool is_few = reasons.AddBeyond(
      kNamesNotFound, static_cast<double>(missing.size()) / static_cast<double>(names), not_found);
  if (!is_few && !missing.empty() && spare > 0) {
    reasons.Add(
        Level::kCheck,
        fmt::format("{}, though {} without a name nearly all along: markers may be worn "
                    "elsewhere",
                    not_found, spare == 1 ? "one point is" : fmt::format("{} points are", spare)));
  }
  JudgeFit(evidence, &reasons);
  reasons.AddBeyond(kUnsure, naming.unsure,
                    fmt::format("names are sure to {:.0f} % only", 100 * (1 - naming.unsure)));
  return reasons.Conclude();
}

}  // namespace mmm_converter
