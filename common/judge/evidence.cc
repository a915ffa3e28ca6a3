// SPDX-License-Identifier: MIT
#include "common/judge/evidence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "common/math/statistics.h"
#include "common/support/advice.h"
#include "common/support/text.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

using Level = Verdict::Level;

// Offsets of calibrated markers, the 95th percentile: right 0.06 to 0.16; legs exchanged 0.19.
constexpr Limit kOffset = {0.18, 0.4};
// Of a landmark that is felt within centimetres [m].
constexpr double kKnownLandmark = 0.012;
constexpr Limit kLandmark = {0.055, kNever};
// A segment's scale less 1, in deviations of what persons have: right at most 3.8 (collarbones).
constexpr Limit kProportion = {5, kNever};
// What a label of a known place is off by: ToldDistances, at most 0.11 where right, of real persons
// and of 9 made ones in 10, whose places are off by 0.028 on each axis; WornDistances, at most 0.11
// of all of these.
constexpr Limit kToldDistance = {0.112, kNever};
// Of noise scales: a place that is known better has a posture about it that is not.
constexpr double kSurestPlace = 0.75;
// Of a capture below 0.001.
constexpr Limit kNoise = {0.003, 0.03};

/// "right leg" for "left leg"; empty: there is none.
std::string OtherSide(const std::string& limb) {
  if (limb.starts_with("left ")) return "right " + limb.substr(5);
  if (limb.starts_with("right ")) return "left " + limb.substr(6);
  return "";
}

std::string LettersOf(const std::string& label) {
  std::string letters;
  for (const char c : label) {
    if ((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c < 0) letters += c;
  }
  return letters;
}

/// "left leg" for "left shank"; empty: no limb's.
std::string LimbOfPart(const std::string& part) {
  const std::size_t blank = part.find(' ');
  if (blank == std::string::npos) return "";
  const std::string side = part.substr(0, blank), bare = part.substr(blank + 1);
  for (const char* one : {"upper arm", "forearm", "hand"}) {
    if (bare == one) return side + " arm";
  }
  for (const char* one : {"thigh", "shank", "ankle", "foot"}) {
    if (bare == one) return side + " leg";
  }
  return "";
}

/// Limbs that wear clusters and nothing of which names tell the place.
void JudgeClusters(const NamedMarkers& names, VerdictReasons* reasons) {
  std::map<std::string, std::vector<std::string>> clusters;  // labels by limb
  std::set<std::string> placed;
  for (const NamedLabel& one : names.labels) {
    const std::string limb = one.marker.empty() ? "" : LimbOfPart(one.part);
    if (limb.empty()) continue;
    if (one.is_cluster) {
      clusters[limb].push_back(one.label);
    } else {
      placed.insert(limb);
    }
  }
  constexpr std::size_t kFewest = 3;  // fewer tell nothing of a limb in any case
  for (const auto& [limb, labels] : clusters) {
    if (placed.contains(limb) || labels.size() < kFewest) continue;
    reasons->Add(Level::kCheck,
                 fmt::format("the {} wears clusters only ({}), whose places names do not tell: a "
                             "recording of the person with markers at the joints, calibrated "
                             "(calibrate), or one with much movement (learn-markers) tells them",
                             limb, FirstNames(labels, 4)));
  }
}

/// The 95th percentile of the offsets [m].
double FarOffset(const Subject& subject) {
  std::vector<double> offsets;
  for (const MarkerOffset& offset : subject.offsets) offsets.push_back(offset.offset.norm());
  return Percentile(offsets, 95);
}

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

void JudgeCoverage(const Coverage& coverage, VerdictReasons* reasons) {
  const std::vector<Limb>& limbs = coverage.limbs;
  const auto is_known = [](const Limb& limb) {
    return limb.IsKnownBy(static_cast<int>(limb.labels.size()));
  };
  // What a recording shows of a body is its own affair, but a limb may have lost its markers.
  std::vector<std::string> lost;
  int degrees = 6;
  for (const Limb& limb : limbs) {
    const int markers = static_cast<int>(limb.labels.size());
    if (is_known(limb)) {
      degrees += limb.num_joints - limb.free_joints;
      continue;
    }
    const std::string other = OtherSide(limb.name);
    const bool has_other = std::any_of(limbs.begin(), limbs.end(), [&](const Limb& one) {
      return one.name == other && is_known(one);
    });
    if (!has_other) continue;
    lost.push_back(
        fmt::format("the {} ({} {})", limb.name, markers, markers == 1 ? "marker" : "markers"));
  }
  if (!lost.empty()) {
    reasons->Add(Level::kCheck,
                 fmt::format("too few markers to know {}", JoinNames(lost, " and ")));
  }
  const std::vector<EndPart>& parts = coverage.ends;
  const bool shows_leg = std::any_of(limbs.begin(), limbs.end(), [&](const Limb& one) {
    return one.name.ends_with("leg") && is_known(one);
  });
  if (shows_leg && !parts.empty() && parts.front().labels.empty()) {
    reasons->Add(Level::kCheck,
                 "no marker is on the pelvis: how it and the hips turn is hardly known");
  }
  const int markers = coverage.num_markers;
  const bool shows_limb = std::any_of(limbs.begin(), limbs.end(), is_known);
  if (3 * markers >= degrees && (shows_limb || limbs.empty())) return;
  reasons->Add(Level::kFailed,
               fmt::format("{} markers are too few for the {} degrees of freedom of the limbs "
                           "that they show",
                           markers, degrees));
}

void JudgeNames(const NamedMarkers& names, VerdictReasons* reasons) {
  JudgeClusters(names, reasons);
  std::vector<std::string> unknown;
  std::set<std::string> kinds;
  for (const NamedLabel& one : names.labels) {
    if (!one.readings.empty() || !one.note.empty()) continue;
    // Of points without names ("U1", "*17") none is missed.
    const std::string kind = LettersOf(one.label);
    if (kind.size() > 1 && kinds.insert(kind).second) unknown.push_back(one.label);
  }
  if (static_cast<int>(unknown.size()) > names.num_used()) {
    reasons->Add(Level::kCheck,
                 WithAdvice(fmt::format("most labels have names that are not understood: {}",
                                        FirstNames(unknown, 6)),
                            Remedy::kMarkerSet));
  }
  const auto contradicted = std::count_if(names.labels.begin(), names.labels.end(),
                                          [](const auto& one) { return one.is_contradicted; });
  if (contradicted == 0) return;
  reasons->Add(2 * contradicted > std::ssize(names.labels) ? Level::kFailed : Level::kCheck,
               fmt::format("labels that are not where their names say: {}",
                           FirstNames(DescribeContradictions(names), 6)));
}

void JudgePlaces(const std::vector<LabelPlace>& places, VerdictReasons* reasons) {
  std::vector<std::string> labels;
  double most = 0;
  for (const LabelPlace& place : places) {
    const double surest = std::min(1.0, place.noise_scale / kSurestPlace);
    if (!kToldDistance.IsBeyond(surest * place.distance)) continue;
    labels.push_back(fmt::format("{} ({:.0f} mm)", place.label,
                                 kMillimetres * place.noise_scale * place.distance));
    most = std::max(most, place.distance);
  }
  reasons->AddBeyond(
      kToldDistance, most,
      fmt::format("labels that are far from where their names say: {}", FirstNames(labels, 6)));
}

void JudgeNoise(double noise, VerdictReasons* reasons) {
  reasons->AddBeyond(kNoise, noise,
                     fmt::format("marker positions have noise of {:.1f} mm, a capture less than 1",
                                 kMillimetres * noise));
}

void JudgeProportions(const Subject& subject, VerdictReasons* reasons) {
  std::vector<std::string> segments;
  double most = 0;
  for (const SegmentScale& scale : subject.scales) {
    if (scale.prior_deviation == 0) continue;  // it was not estimated
    const double change = scale.scale - 1;
    const double deviations = std::abs(change) / scale.prior_deviation;
    most = std::max(most, deviations);
    if (kProportion.IsBeyond(deviations)) {
      segments.push_back(fmt::format("{} {:+.0f} %", scale.segment, kPercent * change));
    }
  }
  reasons->AddBeyond(
      kProportion, most,
      fmt::format("segments are not as long as a person's of that height: {}; wrong labels or too "
                  "little movement do that",
                  FirstNames(segments, 6)));
}

bool AreOffsetsFar(const Subject& subject) { return kOffset.IsBeyond(FarOffset(subject)); }

void JudgeOffsets(const Subject& subject, VerdictReasons* reasons) {
  const double most = FarOffset(subject);
  reasons->AddBeyond(
      kOffset, most,
      fmt::format("5 % of the markers sit more than {:.0f} mm from where the model has them, "
                  "of a person of that height at most {:.0f}",
                  kMillimetres * most, kMillimetres * kOffset.check));
}

void JudgeLandmarks(const Subject& subject, VerdictReasons* reasons) {
  std::vector<std::string> far;
  double most = 0;
  for (const MarkerOffset& one : subject.offsets) {
    if (!(one.prior_deviation > 0) || one.prior_deviation > kKnownLandmark) continue;
    const double distance = one.offset.norm();
    if (!kLandmark.IsBeyond(distance)) continue;
    far.push_back(fmt::format("{} ({:.0f} mm)", one.marker, kMillimetres * distance));
    most = std::max(most, distance);
  }
  reasons->AddBeyond(kLandmark, most,
                     fmt::format("the calibration moves landmarks of bones farther than they are "
                                 "felt: {}; wrong labels and markers that slip do that",
                                 FirstNames(far, 6)));
}

void JudgeSides(const std::optional<ExchangedSides>& exchanged, VerdictReasons* reasons) {
  if (!exchanged) return;
  reasons->Add(Level::kFailed,
               fmt::format("left and right labels of {} are exchanged, or coordinates mirrored: "
                           "exchanged, markers are {:.0f} mm from the model, else {:.0f}",
                           exchanged->part, kMillimetres * exchanged->exchanged_distance,
                           kMillimetres * exchanged->distance));
}

}  // namespace mmm_converter
