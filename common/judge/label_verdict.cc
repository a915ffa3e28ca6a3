// SPDX-License-Identifier: MIT
#include "common/judge/label_verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/judge/evidence.h"
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

/// The names as those of a conversion.
void JudgeMeaning(const LabelEvidence& evidence, bool is_far, VerdictReasons* reasons) {
  const LabelFit& fit = evidence.fit;
  if (evidence.names != nullptr) JudgeNames(*evidence.names, reasons);
  if (evidence.reference == nullptr || fit.setup.assignments().empty()) return;
  if (!evidence.is_calibrated && fit.far_names.empty()) {
    JudgePlaces(fit.setup, fit.frames, fit.trajectory, reasons);
  }
  if (!is_far && evidence.names == nullptr) return;
  JudgeSides(fit.setup, evidence.reference, evidence.person, fit.frames, reasons);
}

void JudgeFit(const LabelEvidence& evidence, VerdictReasons* reasons) {
  const LabelFit& fit = evidence.fit;
  const char* whose = evidence.is_calibrated ? "the subject: another person's, or put on anew since"
                                             : "the model of that height";
  bool is_far = reasons->AddBeyond(
      evidence.is_calibrated ? kCalibratedMeanDistance : kMeanDistance, fit.mean_distance,
      fmt::format("the named points are {:.0f} mm from the markers of {}",
                  kMillimetres * fit.mean_distance, whose));
  is_far |= reasons->AddBeyond(
      evidence.is_calibrated ? kCalibratedPercentile : kPercentile, fit.p95_distance,
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
  JudgeMeaning(evidence, is_far, reasons);
  if (evidence.height <= 0 || fit.told_height <= 0) return;
  const double ratio = fit.told_height / evidence.height;
  reasons->AddBeyond(kHeight, std::abs(ratio - 1),
                     fmt::format("the points are those of a person of {:.2f} m, {:.2f} times the "
                                 "height of {:.2f} m; are the height and the file's unit right?",
                                 fit.told_height, ratio, evidence.height));
}

}  // namespace

std::vector<std::string> NamesNotFound(const Labelling& labelling) {
  std::vector<char> is_found(labelling.names.size(), 0);
  for (const NamedPiece& piece : labelling.pieces) {
    if (piece.name >= 0) is_found[piece.name] = 1;
  }
  std::vector<std::string> names;
  for (std::size_t i = 0; i < is_found.size(); ++i) {
    if (is_found[i] == 0) names.push_back(labelling.names[i]);
  }
  return names;
}

Verdict JudgeLabels(const LabelEvidence& evidence) {
  const MarkerSequence& markers = evidence.recording.markers;
  const Labelling& labelling = evidence.labelling;
  VerdictReasons reasons;
  JudgeReading(evidence.recording, &reasons);
  std::vector<int> unnamed(static_cast<std::size_t>(markers.num_labels()), 0);  // frames, by point
  double unsure = 0, named = 0;
  for (const NamedPiece& piece : labelling.pieces) {
    const int length = piece.end - piece.begin;
    if (piece.name < 0) {
      unnamed[piece.point] += length;
    } else {
      named += length;
      unsure += (1 - piece.probability) * length;
    }
  }
  const std::vector<std::string> missing = NamesNotFound(labelling);
  const std::size_t names = labelling.names.size();
  const auto spare = std::count_if(unnamed.begin(), unnamed.end(),
                                   [&](int n) { return 2 * n > markers.num_frames(); });
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
  if (named > 0) {
    reasons.AddBeyond(kUnsure, unsure / named,
                      fmt::format("names are sure to {:.0f} % only", 100 * (1 - unsure / named)));
  }
  return reasons.Conclude();
}

}  // namespace mmm_converter
