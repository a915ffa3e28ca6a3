// SPDX-License-Identifier: MIT
#include "common/label/learn/named_places.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>

#include "common/convert/exchanged_sides.h"
#include "common/convert/understood_labels.h"
#include "common/label/tuning.h"
#include "common/model/kit_joints.h"
#include "common/support/text.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

/// The labels of one recording that are understood, on the person.
struct Understood {
  NamedMarkers names;
  TrackingSetup setup;
};

Understood Understand(const MarkerSequence& recording, const NamedBody& body) {
  Understood understood;
  const MarkerLabels labels = LabelsOf(recording);
  const std::vector<int>& joints = body.sites.joints();
  understood.names =
      UnderstandLabels(labels, recording, body.reference, ShippedLandmarks(), {joints, true});
  if (understood.names.num_used() < NamedTuning::kFewest) return understood;
  const KinematicModel placed = PlaceMarkers(understood.names.set, {body.reference, true, {}});
  TrackingSetup& setup = understood.setup;
  setup.mapping = ResolveMarkerMapping(PairsInModel(understood.names.set, placed), labels, placed);
  setup.joints = joints;
  setup.model = std::make_shared<const KinematicModel>(body.scale(placed));
  return understood;
}

/// "arm", "leg" or neither.
std::string LimbOf(const KinematicModel& model, int segment) {
  while (segment > 0) {
    const std::string limb = LimbOfJoint(model.segments()[segment].name);
    if (!limb.empty()) return limb.substr(limb.find_last_of(' ') + 1);
    segment = model.segments()[segment].parent;
  }
  return "";
}

/// Labels of markers that are called alike but for the side get each other's markers.
void ExchangeSides(const std::string& part, TrackingSetup* setup) {
  std::vector<MarkerAssignment>& assignments = setup->mapping.assignments;
  const std::vector<int> mirrored = MirroredMarkers(*setup->model, MarkerIndices(assignments));
  for (std::size_t i = 0; i < mirrored.size(); ++i) {
    if (mirrored[i] <= static_cast<int>(i)) continue;
    const std::string limb =
        LimbOf(*setup->model, setup->model->markers()[assignments[i].marker].segment);
    if (part != "all markers" && (limb.empty() || !part.ends_with(limb + "s"))) continue;
    std::swap(assignments[i].label, assignments[static_cast<std::size_t>(mirrored[i])].label);
  }
}

void WarnOfContradicted(const NamedMarkers& names, std::vector<std::string>* warnings) {
  std::vector<std::string> contradicted;
  for (const NamedLabel& one : names.labels) {
    if (!one.is_contradicted) continue;
    contradicted.push_back(fmt::format("{} ({})", one.label, one.note));
  }
  if (contradicted.empty()) return;
  warnings->push_back(
      fmt::format("labels that are not where their names say: {}", FirstNames(contradicted)));
}

/// Labels that are at none of the places that their names can mean.
int CountElsewhere(const NamedMarkers& names) {
  return static_cast<int>(std::count_if(
      names.labels.begin(), names.labels.end(),
      [](const NamedLabel& one) { return one.is_contradicted && one.marker.empty(); }));
}

NamedPlace PlaceOfMarker(const ModelMarker& marker, const NamedLabel& name, double noise_scale,
                         const BodySites& sites) {
  NamedPlace place;
  const auto [site, p_SM] = sites.OnSite(marker.segment, marker.p_SM);
  place.site = site;
  place.p_SM = p_SM;
  place.is_at_place = !name.is_cluster;
  place.deviation = NamedTuning::kDeviation * noise_scale;
  return place;
}

}  // namespace

NamedPlaces FindNamedPlaces(const std::vector<std::string>& labels,
                            const std::vector<const MarkerSequence*>& recordings,
                            const NamedBody& body) {
  NamedPlaces found;
  found.labels.resize(labels.size());
  for (const MarkerSequence* recording : recordings) {
    Understood understood = Understand(*recording, body);
    const NamedMarkers& names = understood.names;
    if (names.num_used() < NamedTuning::kFewest) continue;
    WarnOfContradicted(names, &found.warnings);
    if (CountElsewhere(names) > NamedTuning::kMostContradicted * names.num_used()) continue;
    if (const auto exchanged = FindExchangedSides(understood.setup, *recording)) {
      found.warnings.push_back(fmt::format(
          "left and right labels of {} are exchanged, or coordinates mirrored: exchanged, markers "
          "are {:.0f} mm from the model, else {:.0f}",
          exchanged->part, kMillimetres * exchanged->exchanged_distance,
          kMillimetres * exchanged->distance));
      ExchangeSides(exchanged->part, &understood.setup);
    }
    std::map<std::string, const NamedLabel*> by_label;
    for (const NamedLabel& one : names.labels) by_label.emplace(one.label, &one);
    for (const MarkerAssignment& one : understood.setup.assignments()) {
      const std::string& label = recording->labels()[one.label];
      const NamedLabel& name = *by_label.at(label);
      const auto at = std::find(labels.begin(), labels.end(), label) - labels.begin();
      NamedPlace& place = found.labels[static_cast<std::size_t>(at)];
      if (place.site >= 0) continue;
      place = PlaceOfMarker(understood.setup.model->markers()[one.marker], name, one.noise_scale,
                            body.sites);
    }
    break;
  }
  return found;
}

}  // namespace mmm_converter
