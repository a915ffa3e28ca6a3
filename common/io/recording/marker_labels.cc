// SPDX-License-Identifier: MIT
#include "common/io/recording/marker_labels.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <set>

#include "common/io/landmarks/label_readings.h"
#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

constexpr int kMarkersOfAPerson = 8;  // of a common set; objects have fewer, by other names
constexpr int kMarkersOfAPart = 3;

/// By the part of the body that a landmark is of.
BodyRegion RegionOf(const Landmark& landmark) {
  constexpr std::pair<std::string_view, BodyRegion> kRegions[] = {
      {"head", BodyRegion::kHead},          {"neck", BodyRegion::kShoulders},
      {"shoulder", BodyRegion::kShoulders}, {"thorax", BodyRegion::kThorax},
      {"pelvis", BodyRegion::kPelvis},      {"ankle", BodyRegion::kFeet},
      {"foot", BodyRegion::kFeet}};
  for (const auto& [part, region] : kRegions) {
    if (landmark.part == part) return region;
  }
  return BodyRegion::kElsewhere;
}

/// Whether a label by itself names a landmark, with its side where it has one.
bool IsLandmark(std::string_view label) {
  const LandmarkTable& table = ShippedLandmarks();
  const std::vector<LabelReading> readings = ReadingsOf(label, table);
  return std::any_of(readings.begin(), readings.end(), [&](const LabelReading& one) {
    return one.side != BodySide::kNone ||
           !table.landmarks()[static_cast<std::size_t>(one.landmark)].is_sided;
  });
}

/// A label, taken apart.
struct Label {
  int index = 0;
  std::string prefix;
  std::string name;
};

Label TakeApart(int index, std::string_view label, const std::set<std::string_view>& prefixes) {
  const auto part = [&](std::size_t at) {
    return Label{index, std::string(Trim(label.substr(0, at))),
                 std::string(Trim(label.substr(at + 1)))};
  };
  const std::size_t colon = label.rfind(':');
  if (colon != std::string_view::npos) return part(colon);
  const std::size_t bar = label.find('_');
  if (bar != std::string_view::npos && bar > 0) {
    const std::string_view prefix = label.substr(0, bar);
    const bool declared = prefixes.contains(prefix) || prefixes.contains(label.substr(0, bar + 1));
    if (declared || (IsLandmark(label.substr(bar + 1)) && !IsLandmark(label))) return part(bar);
  }
  return {index, "", std::string(Trim(label))};
}

/// Labels of bone axes: four points, all with the same name but for the last letter.
std::set<std::string> BoneAxes(const std::vector<std::string>& labels) {
  const std::set<std::string> all(labels.begin(), labels.end());
  std::set<std::string> axes;
  for (const std::string& label : labels) {
    if (label.size() < 3 || label.back() != 'O') continue;
    const std::string bone = label.substr(0, label.size() - 1);
    if (!all.contains(bone + 'A') || !all.contains(bone + 'L') || !all.contains(bone + 'P')) {
      continue;
    }
    for (const char axis : {'O', 'A', 'L', 'P'}) axes.insert(bone + axis);
  }
  return axes;
}

/// What is left when everything that is no marker is gone.
struct MarkersAndPoints {
  std::vector<Label> markers;
  std::vector<Label> unlabelled;
};

MarkersAndPoints KeepMarkers(const std::vector<std::string>& labels,
                             const std::vector<std::string>& outputs,
                             const std::set<std::string_view>& prefixes, Warnings* warnings) {
  const std::set<std::string> no_markers(outputs.begin(), outputs.end());
  const std::set<std::string> axes = BoneAxes(labels);
  MarkersAndPoints kept;
  int computed = 0;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    Label label = TakeApart(static_cast<int>(i), labels[i], prefixes);
    if (label.name.empty() || label.name.starts_with('*')) {
      if (label.name.empty()) label.name = fmt::format("*{}", i + 1);
      kept.unlabelled.push_back(std::move(label));
    } else if (axes.contains(labels[i]) || no_markers.contains(labels[i])) {
      ++computed;
      if (IsLandmark(label.name)) {
        WarnOfKind(
            warnings, "points that are computed here",
            fmt::format("{} is a computed point here (Plug-in Gait), not a marker", labels[i]));
      }
    } else {
      kept.markers.push_back(std::move(label));
    }
  }
  if (computed > 0) {
    Warn(warnings,
         fmt::format("{} computed points (angles, forces, bone axes, ...) left out", computed));
  }
  return kept;
}

/// One subject, or the labels without prefix.
struct Group {
  std::string prefix;
  std::vector<Label> labels;
  bool IsPerson() const { return num_known() >= kMarkersOfAPerson; }
  bool IsPartOfPerson() const {
    return num_known() >= kMarkersOfAPart &&
           2 * num_known() >= static_cast<std::ptrdiff_t>(labels.size());
  }

 private:
  std::ptrdiff_t num_known() const {
    return std::count_if(labels.begin(), labels.end(),
                         [](const Label& label) { return IsLandmark(label.name); });
  }
};

std::vector<Group> GroupByPrefix(std::vector<Label> labels) {
  std::vector<Group> groups;
  std::map<std::string, std::size_t> places;  // of a prefix, in groups
  for (Label& label : labels) {
    const auto [place, is_new] = places.emplace(label.prefix, groups.size());
    if (is_new) groups.push_back({label.prefix, {}});
    groups[place->second].labels.push_back(std::move(label));
  }
  return groups;
}

std::string NameOfGroup(const Group& group) {
  return group.prefix.empty() ? "(labels without prefix)" : group.prefix;
}

std::string Names(const std::vector<Group>& groups) {
  std::vector<std::string> names(groups.size());
  std::transform(groups.begin(), groups.end(), names.begin(), NameOfGroup);
  return FirstNames(names);
}

/// Labels in the order of the file.
std::vector<Label> LabelsOf(const std::vector<Group>& groups) {
  std::vector<Label> labels;
  for (const Group& group : groups) {
    labels.insert(labels.end(), group.labels.begin(), group.labels.end());
  }
  std::stable_sort(labels.begin(), labels.end(),
                   [](const Label& a, const Label& b) { return a.index < b.index; });
  return labels;
}

/// Whether no name would be there twice, were they one.
bool AreDisjoint(const std::vector<Group>& groups) {
  std::set<std::string> names;
  for (const Group& group : groups) {
    for (const Label& label : group.labels) {
      if (!names.insert(NormalizeLabel(label.name)).second) return false;
    }
  }
  return true;
}

const Group* FindGroup(const std::vector<Group>& groups, std::string_view prefix) {
  std::string_view wanted = Trim(prefix);
  if (wanted.ends_with(':')) wanted = Trim(wanted.substr(0, wanted.size() - 1));
  for (const Group& group : groups) {
    if (EqualIgnoringCase(group.prefix, wanted)) return &group;
  }
  return nullptr;
}

/// The group of that prefix, or those of the prefixes between commas.
std::vector<Group> AskedFor(const std::vector<Group>& groups, const std::string& subject,
                            const std::string& file) {
  if (const Group* one = FindGroup(groups, subject)) return {*one};
  std::vector<Group> chosen;
  for (std::string_view rest = subject;;) {
    const std::size_t end = rest.find(',');
    const Group* one = FindGroup(groups, rest.substr(0, end));
    if (one == nullptr) {
      const std::string_view name = Trim(rest.substr(0, end));
      throw Error(fmt::format("{}: there is no subject {}; the file has: {}", file,
                              name.empty() ? "without prefix" : name,
                              groups.empty() ? "none" : Names(groups)));
    }
    const bool is_new = std::none_of(chosen.begin(), chosen.end(), [&](const Group& group) {
      return group.prefix == one->prefix;
    });
    if (is_new) chosen.push_back(*one);
    if (end == std::string_view::npos) return chosen;
    rest.remove_prefix(end + 1);
  }
}

/// Without those of which no frame shows a label, if others are left, and without Cortex's computed
/// markers beside a person.
std::vector<Group> Present(std::vector<Group> groups,
                           const std::function<std::vector<bool>()>& are_seen) {
  const std::vector<bool> seen = are_seen ? are_seen() : std::vector<bool>();
  const auto is_absent = [&](const Group& group) {
    return std::none_of(group.labels.begin(), group.labels.end(), [&](const Label& label) {
      return seen.empty() || seen[static_cast<std::size_t>(label.index)];
    });
  };
  const bool is_any = !std::all_of(groups.begin(), groups.end(), is_absent);
  if (is_any) std::erase_if(groups, is_absent);
  const bool has_person = std::any_of(groups.begin(), groups.end(), [](const Group& group) {
    return group.prefix.empty() && group.IsPerson();
  });
  if (has_person) {
    std::erase_if(groups, [](const Group& group) { return EqualIgnoringCase(group.prefix, "V"); });
  }
  return groups;
}

/// The one person, who may wear parts of a marker set under several prefixes.
std::vector<Group> ChooseGroups(const std::vector<Group>& all,
                                const std::optional<std::string>& subject, const std::string& file,
                                const std::function<std::vector<bool>()>& are_seen,
                                Warnings* warnings) {
  if (subject) return AskedFor(all, *subject, file);
  if (all.size() <= 1) return all;
  const std::vector<Group> groups = Present(all, are_seen);
  if (groups.size() == 1) return groups;
  std::vector<Group> parts;
  std::vector<Group> persons;
  for (const Group& group : groups) {
    if (group.IsPartOfPerson()) parts.push_back(group);
    if (group.IsPerson()) persons.push_back(group);
  }
  if (parts.size() > 1 && AreDisjoint(parts)) {
    Warn(warnings,
         fmt::format("markers of {} are parts of one body: read as one person", Names(parts)));
    return parts;
  }
  if (persons.size() == 1) return persons;
  if (persons.empty() && AreDisjoint(groups)) return groups;
  throw Error(fmt::format("{}: there are several subjects: {}; choose one of them", file,
                          Names(persons.empty() ? groups : persons)),
              Remedy::kSubjectPrefix);
}

std::vector<std::string> AllToUtf8(const std::vector<std::string>& texts) {
  std::vector<std::string> converted(texts.size());
  std::transform(texts.begin(), texts.end(), converted.begin(),
                 [](const std::string& text) { return ToUtf8(text); });
  return converted;
}

/// Labels may become the same when they are converted, or when their prefixes are gone.
std::vector<std::string> UniqueNames(const std::vector<Label>& labels, Warnings* warnings) {
  std::vector<std::string> names;
  std::vector<std::string> renamed;
  std::set<std::string> known;
  for (const Label& label : labels) known.insert(label.name);
  std::map<std::string, int> counts;
  for (const Label& label : labels) {
    int& count = counts[label.name];
    std::string name = label.name;
    if (++count > 1) {
      while (!known.insert(name = fmt::format("{}#{}", label.name, count)).second) ++count;
      renamed.push_back(name);
    }
    names.push_back(std::move(name));
  }
  if (!renamed.empty()) {
    Warn(warnings, fmt::format("labels that are the same as others, without prefixes and in UTF-8, "
                               "are numbered: {}",
                               FirstNames(renamed)));
  }
  return names;
}

}  // namespace

std::string NormalizeLabel(std::string_view label) {
  std::string normalized;
  for (const char c : ToLower(label)) {
    const bool punctuation = c >= 0 && !(c >= 'a' && c <= 'z') && !(c >= '0' && c <= '9');
    if (!punctuation) normalized.push_back(c);
  }
  return normalized;
}

std::vector<std::optional<BodyRegion>> BodyRegionsOf(const std::vector<std::string>& labels) {
  const LandmarkTable& table = ShippedLandmarks();
  std::vector<std::optional<BodyRegion>> regions;
  regions.reserve(labels.size());
  for (const ReadLabel& one : ReadLabels(labels, {}, table)) {
    regions.emplace_back();
    if (one.readings.empty()) continue;
    regions.back() =
        RegionOf(table.landmarks()[static_cast<std::size_t>(one.readings.front().landmark)]);
  }
  return regions;
}

LabelSelection SelectLabels(const std::vector<std::string>& labels,
                            const std::vector<std::string>& outputs,
                            const std::vector<std::string>& label_prefixes,
                            const std::optional<std::string>& subject, const std::string& file,
                            Warnings* warnings, bool with_unlabelled,
                            const std::function<std::vector<bool>()>& are_seen) {
  LabelSelection selection;
  const std::vector<std::string> prefixes = AllToUtf8(label_prefixes);
  MarkersAndPoints kept = KeepMarkers(AllToUtf8(labels), AllToUtf8(outputs),
                                      {prefixes.begin(), prefixes.end()}, warnings);
  const std::vector<Group> groups = GroupByPrefix(std::move(kept.markers));
  const std::vector<Group> chosen = ChooseGroups(groups, subject, file, are_seen, warnings);
  std::vector<Label> all = LabelsOf(chosen);
  std::set<std::string> prefixes_chosen;
  for (const Group& group : chosen) prefixes_chosen.insert(group.prefix);
  // A person whose parts have prefixes of their own has no name.
  if (chosen.size() == 1) selection.subject = chosen.front().prefix;
  std::vector<Group> others;
  for (const Group& group : groups) {
    if (!group.prefix.empty()) selection.subjects.push_back(group.prefix);
    if (!prefixes_chosen.contains(group.prefix)) others.push_back(group);
  }
  if (!others.empty()) {
    Warn(warnings, fmt::format("markers left out: those of {}", Names(others)));
  }
  if (with_unlabelled) {
    all.insert(all.end(), kept.unlabelled.begin(), kept.unlabelled.end());
    std::stable_sort(all.begin(), all.end(),
                     [](const Label& a, const Label& b) { return a.index < b.index; });
  } else if (!kept.unlabelled.empty()) {
    Warn(warnings, fmt::format("{} unlabelled points left out", kept.unlabelled.size()));
  }
  for (const Label& label : all) selection.indices.push_back(label.index);
  selection.labels = UniqueNames(all, warnings);
  return selection;
}

LabelSelection SelectAllSubjects(const std::vector<std::string>& labels,
                                 const std::vector<std::string>& outputs,
                                 const std::vector<std::string>& label_prefixes,
                                 Warnings* warnings) {
  const std::vector<std::string> prefixes = AllToUtf8(label_prefixes);
  std::vector<Label> all = KeepMarkers(AllToUtf8(labels), AllToUtf8(outputs),
                                       {prefixes.begin(), prefixes.end()}, warnings)
                               .markers;
  LabelSelection selection;
  std::set<std::string> subjects;
  for (Label& label : all) {
    selection.indices.push_back(label.index);
    if (label.prefix.empty()) continue;
    if (subjects.insert(label.prefix).second) selection.subjects.push_back(label.prefix);
    label.name = label.prefix + ":" + label.name;
  }
  selection.labels = UniqueNames(all, warnings);
  return selection;
}

}  // namespace mmm_converter
