// SPDX-License-Identifier: MIT
#include "common/label/learn/learn_doubts.h"

#include <fmt/format.h>

#include <algorithm>

#include "common/label/learn/learn_frames.h"
#include "common/label/learn/marker_names.h"
#include "common/label/tuning.h"
#include "common/support/text.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

std::string NameOfSite(const LearnEvidence& evidence, int site) {
  return evidence.sites.model().segments()[evidence.sites.sites()[site].segment].name;
}

/// Why the site of a label is not believed; empty: it is. What only moves says is not enough where
/// both sites are near, but for markers whose names say the same, and for those that keep their
/// distances from one of these far better.
std::string DoubtOf(const LearnEvidence& evidence, int label, double probability) {
  const LearnedPlaces& learned = evidence.learned;
  const std::vector<int> of_labels = learned.SitesOfLabels();
  const int site = of_labels[label];
  const auto deviation_from = [&](int other) {
    return DeviationFrom(other, label, of_labels, evidence.deviations);
  };
  const double own = deviation_from(site).value_or(DoubtTuning::kRigidly);
  const auto prior = learned.prior_costs().row(label);
  const bool is_named = evidence.named[label].site == site;
  int usual = site;
  for (const int other : evidence.sites.Neighbours(site)) {
    const auto others = deviation_from(other);
    const bool is_far_better =
        others && (own < DoubtTuning::kRigidly) && (*others > DoubtTuning::kFarBetter * own);
    if (!is_far_better && !is_named &&
        prior[other] < std::min(prior[site] - DoubtTuning::kClearly, prior[usual])) {
      usual = other;
    }
  }
  const WornPlace& worn = learned.places()[label];
  const bool is_rigid = own < DoubtTuning::kRigidly;
  if (learned.DistanceBeyond(site, worn.p_SM) >
      (is_rigid ? DoubtTuning::kLongestWand : DoubtTuning::kOutside)) {
    return fmt::format("moves like {}, but too far from it", NameOfSite(evidence, site));
  }
  if (worn.scatter > DoubtTuning::kMostScatter) {
    return fmt::format("moves by {:.0f} mm on {}", kMillimetres * worn.scatter,
                       NameOfSite(evidence, site));
  }
  if (usual != site) {
    return fmt::format("moves like {}, but is where {} has its markers", NameOfSite(evidence, site),
                       NameOfSite(evidence, usual));
  }
  if (probability < DoubtTuning::kSure) {
    return fmt::format("on {} with a probability of {:.2f} only", NameOfSite(evidence, site),
                       probability);
  }
  return "";
}

/// Warns where names say another side than the body; single ones of them are left out.
void CheckNamedSides(const LearnEvidence& evidence, LearnedMarkers* result) {
  const std::vector<std::string>& names = evidence.names;
  const std::vector<NamedSide> named = NamedSides(names);
  std::vector<int> contradicted;
  int confirmed = 0;
  for (int l = 0; l < static_cast<int>(names.size()); ++l) {
    const int site = evidence.learned.places()[l].site;
    if (named[l] == NamedSide::kNone || site < 0) continue;
    const std::string& side = evidence.sites.sites()[site].side;
    if (side.empty()) continue;
    if ((side == "left") == (named[l] == NamedSide::kLeft)) {
      ++confirmed;
    } else {
      contradicted.push_back(l);
    }
  }
  if (contradicted.empty()) return;
  if (static_cast<int>(contradicted.size()) > confirmed) {
    result->warnings.push_back(fmt::format(
        "{} of {} labels name the other side than that on which the body has them, {} for "
        "instance: are left and right exchanged, or is the recording mirrored?",
        contradicted.size(), contradicted.size() + static_cast<std::size_t>(confirmed),
        names[contradicted.front()]));
    return;
  }
  for (const int l : contradicted) {
    result->markers[l].left_out =
        fmt::format("moves like {}, which its name contradicts", result->markers[l].segment);
  }
}

/// Warns where usual names say another part of the body.
void CheckNamedParts(const LearnEvidence& evidence, LearnedMarkers* result) {
  std::vector<std::string> contradicted;
  for (std::size_t l = 0; l < evidence.names.size(); ++l) {
    const int site = evidence.learned.places()[l].site;
    const LearnedMarker& marker = result->markers[l];
    if (site < 0 || !marker.left_out.empty()) continue;
    if (evidence.named[l].site >= 0 && evidence.named[l].site != site) {
      contradicted.push_back(fmt::format("{} ({})", marker.label, marker.segment));
    }
  }
  if (contradicted.empty()) return;
  result->warnings.push_back(
      fmt::format("labels whose names say another part of the body than the segment that they move "
                  "with, which is believed: {}",
                  FirstNames(contradicted)));
}

}  // namespace

void LeaveOutDoubtful(const LearnEvidence& evidence, LearnedMarkers* markers) {
  for (int l = 0; l < static_cast<int>(evidence.names.size()); ++l) {
    LearnedMarker& marker = markers->markers[l];
    if (!marker.left_out.empty() || evidence.learned.places()[l].site < 0) continue;
    marker.left_out = DoubtOf(evidence, l, marker.probability);
  }
  CheckNamedSides(evidence, markers);
  CheckNamedParts(evidence, markers);
}

}  // namespace mmm_converter
