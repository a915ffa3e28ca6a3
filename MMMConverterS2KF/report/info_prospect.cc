// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/report/info_prospect.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "MMMConverterS2KF/report/names_summary.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

// Names of limbs that so many joints' worth of markers show, or of the others.
std::vector<std::string> LimbNames(const Prospect& prospect, bool is_known) {
  std::vector<std::string> names;
  for (const Limb& limb : prospect.limbs) {
    const bool has_enough = limb.IsKnownBy(static_cast<int>(limb.labels.size()));
    if (has_enough == is_known) names.push_back(limb.name);
  }
  return names;
}

std::string NamesOrNone(const std::vector<std::string>& names) {
  return names.empty() ? "none" : FirstNames(names);
}

}  // namespace

std::string FormatProspect(const Prospect& prospect) {
  if (!prospect.failure.empty()) return fmt::format("converting fails: {}\n", prospect.failure);
  const MarkerMapping& mapping = prospect.mapping;
  std::string text =
      fmt::format("marker set {}: {} labels used; not known: {}; not there: {}\n",
                  prospect.marker_set.empty() ? "of the configuration" : prospect.marker_set,
                  mapping.assignments.size(), NamesOrNone(mapping.ignored_labels),
                  NamesOrNone(mapping.absent_markers));
  if (prospect.names)
    text += "names      " + DescribeNames(*prospect.names) + FormatNames(*prospect.names);
  if (!prospect.limbs.empty()) {
    text +=
        fmt::format("shown      {}; too few markers: {}\n", NamesOrNone(LimbNames(prospect, true)),
                    NamesOrNone(LimbNames(prospect, false)));
  }
  for (const Gap& gap : prospect.gaps) {
    text +=
        fmt::format("hidden     {}, frames {} to {}\n", gap.what, gap.first_frame, gap.last_frame);
  }
  if (prospect.person.height.value > 0) {
    text += fmt::format("height     {}\n", DescribeHeight(prospect.person));
  }
  for (const std::string& doubt : prospect.doubts) text += fmt::format("doubtful   {}\n", doubt);
  return text;
}

Json ToJson(const Prospect& prospect) {
  Json gaps = Json::array();
  for (const Gap& gap : prospect.gaps) {
    gaps.push_back(
        {{"what", gap.what}, {"first_frame", gap.first_frame}, {"last_frame", gap.last_frame}});
  }
  const Person& person = prospect.person;
  return {{"failure", TextOrNull(prospect.failure)},
          {"marker_set", TextOrNull(prospect.marker_set)},
          {"markers_used", prospect.mapping.assignments.size()},
          {"ignored", prospect.mapping.ignored_labels},
          {"absent", prospect.mapping.absent_markers},
          {"names", prospect.names ? NamesJson(*prospect.names) : Json(nullptr)},
          {"shown", LimbNames(prospect, true)},
          {"not_shown", LimbNames(prospect, false)},
          {"hidden", gaps},
          {"height_m", person.height.value > 0 ? Number(person.height.value) : Json(nullptr)},
          {"height_deviation_m",
           person.height_deviation > 0 ? Number(person.height_deviation) : Json(nullptr)},
          {"doubts", prospect.doubts}};
}

}  // namespace mmm_converter
