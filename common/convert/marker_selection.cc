// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <filesystem>

#include "common/convert/converter_config.h"
#include "common/convert/marker_set.h"
#include "common/support/advice.h"
#include "common/support/data_directory.h"
#include "common/support/error.h"
#include "common/support/suggestion.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

namespace fs = std::filesystem;

std::string StemOf(const MarkerSet& set) { return fs::path(set.file).stem().string(); }

const MarkerSet& FindSet(const std::vector<MarkerSet>& sets, const ConverterConfig& config) {
  std::vector<std::string> names;
  for (const MarkerSet& set : sets) {
    if (EqualIgnoringCase(set.name, config.marker_set) ||
        EqualIgnoringCase(StemOf(set), config.marker_set)) {
      return set;
    }
    names.push_back(StemOf(set));
  }
  const std::string closest = ClosestName(config.marker_set, names);
  names.emplace_back("auto");
  const std::string asked =
      config.marker_set_line > 0
          ? fmt::format("{}:{}: <MarkerMapping>", config.file, config.marker_set_line)
          : OptionText("marker-set");
  throw Error(fmt::format(
      "{}: there is no marker set \"{}\"{}; use {}, or a file (*.xml)", asked, config.marker_set,
      closest.empty() ? "" : " (did you mean " + closest + "?)", JoinNames(names)));
}

/// As far as the model has their markers, and the model's own names.
void FitToModel(const KinematicModel& model, std::vector<MarkerSet>* sets) {
  for (MarkerSet& set : *sets) set.pairs = PairsInModel(set, model);
  sets->push_back(OwnMarkerSet(model));
}

}  // namespace

std::optional<MarkerSet> FindKnownSet(const MarkerLabels& labels, const KinematicModel& model) {
  std::vector<MarkerSet> sets = ReadMarkerSets(DataFile("marker_sets"));
  FitToModel(model, &sets);
  const MarkerSet* const found = FindMarkerSet(sets, labels);
  return found == nullptr ? std::nullopt : std::optional(*found);
}

std::optional<MarkerSet> ReadOwnMarkerSet(const ConverterConfig& config) {
  if (!config.marker_pairs.empty() || !config.marker_set.ends_with(".xml")) return std::nullopt;
  return ReadMarkerSet((fs::path(config.file).parent_path() / config.marker_set).string());
}

std::vector<MarkerPair> ResolveMarkerPairs(const ConverterConfig& config,
                                           const MarkerLabels& labels, const KinematicModel& model,
                                           std::string* name) {
  name->clear();
  if (!config.marker_pairs.empty()) return config.marker_pairs;
  if (const auto own = ReadOwnMarkerSet(config)) {
    *name = own->name;
    return PairsInModel(*own, model);
  }
  std::vector<MarkerSet> sets = ReadMarkerSets(DataFile("marker_sets"));
  const bool is_free = config.marker_set == "auto";
  if (is_free) FitToModel(model, &sets);
  const MarkerSet& set = is_free ? ChooseMarkerSet(sets, labels) : FindSet(sets, config);
  *name = set.name;
  return PairsInModel(set, model);
}

}  // namespace mmm_converter
