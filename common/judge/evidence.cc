// SPDX-License-Identifier: MIT
#include "common/judge/evidence.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "common/convert/exchanged_sides.h"
#include "common/math/statistics.h"
#include "common/motion/marker_noise.h"
#include "common/support/advice.h"
#include "common/support/text.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

using Level = Verdict::Level;

// Offsets of calibrated markers, the 95th percentile: right 0.06 to 0.16; legs exchanged 0.19.
constexpr Limit kOffset = {0.18, 0.4};
// Of a capture below 0.001.
constexpr Limit kNoise = {0.003, 0.03};
// Of the six limbs: none, and half of the body.
constexpr Limit kUnseenLimbs = {0, 2};

}  // namespace

bool VerdictReasons::AddBeyond(const Limit& limit, double value, const std::string& reason) {
  if (!limit.IsBeyond(value)) return false;
  Add(limit.LevelOf(value), reason);
  return true;
}

Verdict VerdictReasons::Conclude() {
  std::stable_sort(reasons_.begin(), reasons_.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  Verdict verdict;
  if (!reasons_.empty()) verdict.level = reasons_.front().first;
  for (auto& [unused, reason] : reasons_) verdict.reasons.push_back(std::move(reason));
  return verdict;
}

void JudgeReading(const Recording& recording, VerdictReasons* reasons) {
  for (const ReadingDoubt& doubt : recording.doubts) {
    reasons->Add(Level::kCheck, WithAdvice(doubt.text, doubt.remedy));
  }
}

void JudgeCoverage(const TrackingSetup& setup, const std::vector<Limb>& limbs,
                   VerdictReasons* reasons) {
  std::vector<std::string> unseen;
  for (const Limb& limb : limbs) {
    const int markers = static_cast<int>(limb.labels.size());
    if (!limb.IsKnownBy(markers)) {
      unseen.push_back(
          fmt::format("the {} ({} {})", limb.name, markers, markers == 1 ? "marker" : "markers"));
    } else if (limb.free_joints > 0) {
      reasons->Add(Level::kCheck, fmt::format("{}: no marker shows {} of its {} joints", limb.name,
                                              limb.free_joints, limb.num_joints));
    }
  }
  reasons->AddBeyond(kUnseenLimbs, static_cast<double>(unseen.size()),
                     fmt::format("too few markers to know {}", JoinNames(unseen, " and ")));
  const auto coordinates = 3 * setup.assignments().size();
  const auto degrees = 6 + setup.joints.size();
  if (coordinates >= degrees) return;
  reasons->Add(Level::kCheck,
               fmt::format("{} markers are too few for the {} degrees of freedom of the body",
                           setup.assignments().size(), degrees));
}

void JudgeNoise(const TrackingSetup& setup, const MarkerSequence& markers,
                VerdictReasons* reasons) {
  const double noise = MeasureMarkerNoise(markers, LabelIndices(setup.assignments()));
  reasons->AddBeyond(kNoise, noise,
                     fmt::format("marker positions have noise of {:.1f} mm, a capture less than 1",
                                 kMillimetres * noise));
}

bool JudgeOffsets(const Subject& subject, VerdictReasons* reasons) {
  std::vector<double> offsets;
  for (const MarkerOffset& offset : subject.offsets) offsets.push_back(offset.offset.norm());
  const double most = Percentile(offsets, 95);
  return reasons->AddBeyond(
      kOffset, most,
      fmt::format("one in twenty markers sits more than {:.0f} mm from where the model has it, "
                  "of a person of that height at most {:.0f}",
                  kMillimetres * most, kMillimetres * kOffset.check));
}

void JudgeSides(TrackingSetup setup, std::shared_ptr<const KinematicModel> reference,
                PersonScaling person, const MarkerSequence& markers, VerdictReasons* reasons) {
  setup.model = std::move(reference);  // a subject's markers may have taken it up
  person.subject = nullptr;
  ScaleToPerson(person, &setup);
  const auto exchanged = FindExchangedSides(setup, markers);
  if (!exchanged) return;
  reasons->Add(Level::kFailed,
               fmt::format("left and right labels of {} are exchanged, or coordinates mirrored: "
                           "exchanged, markers are {:.0f} mm from the model, else {:.0f}",
                           exchanged->part, kMillimetres * exchanged->exchanged_distance,
                           kMillimetres * exchanged->distance));
}

}  // namespace mmm_converter
