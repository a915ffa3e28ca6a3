// SPDX-License-Identifier: MIT
#include "common/live/shared_labels.h"

#include <fmt/format.h>

#include <map>
#include <set>
#include <tuple>

#include "common/model/posture.h"
#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

struct SubjectAndName {
  std::string subject, name;
};

SubjectAndName TakeApart(const std::string& label) {
  const std::size_t colon = label.rfind(':');
  if (colon == std::string::npos) return {"", label};
  return {label.substr(0, colon), label.substr(colon + 1)};
}

// The labels that may be the object's, by their subject.
std::map<std::string, std::vector<int>> PlacesBySubject(const std::vector<std::string>& labels,
                                                        const LabelledObject& object) {
  std::map<std::string, std::vector<int>> own, by_name;
  const std::set<std::string> names(object.labels.begin(), object.labels.end());
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const auto [subject, name] = TakeApart(labels[i]);
    const int place = static_cast<int>(i);
    if (EqualIgnoringCase(subject, object.name)) own[subject].push_back(place);
    if (names.contains(labels[i])) {
      by_name[""].push_back(place);
    } else if (names.contains(name)) {
      by_name[subject].push_back(place);
    }
  }
  if (!own.empty()) return own;
  std::erase_if(by_name, [](const auto& one) { return one.second.size() < kFewestMarkers; });
  return by_name;
}

LabelSelection LabelsOf(const std::vector<std::string>& labels, const LabelledObject& object,
                        const std::string& source) {
  const auto places = PlacesBySubject(labels, object);
  if (places.empty()) {
    throw Error(
        fmt::format("{}: has no three labels of the object {}, whose markers are {}; labels are {}",
                    source, object.name, FirstNames(object.labels), FirstNames(labels)));
  }
  if (places.size() > 1) {
    std::vector<std::string> subjects;
    subjects.reserve(places.size());
    for (const auto& [subject, unused] : places) {
      subjects.push_back(subject.empty() ? "(without prefix)" : subject);
    }
    throw Error(
        fmt::format("{}: markers of the object {} are there under several prefixes, {}; call "
                    "the file of its model as its own",
                    source, object.name, JoinNames(subjects)));
  }
  LabelSelection selection;
  std::tie(selection.subject, selection.indices) = *places.begin();
  for (const int i : selection.indices) {
    const std::string& label = labels[static_cast<std::size_t>(i)];
    selection.labels.push_back(selection.subject.empty() ? label : TakeApart(label).name);
  }
  return selection;
}

}  // namespace

std::vector<LabelSelection> ShareLabels(const std::vector<std::string>& labels,
                                        const std::vector<LabelledObject>& objects,
                                        const std::string& source) {
  std::vector<LabelSelection> shares;
  std::map<int, std::string> owners;
  for (const LabelledObject& object : objects) {
    shares.push_back(LabelsOf(labels, object, source));
    for (const int i : shares.back().indices) {
      const auto [owner, is_new] = owners.emplace(i, object.name);
      if (is_new) continue;
      throw Error(
          fmt::format("{}: the label {} is of the object {} and of {}; prefixes in the "
                      "source tell them apart, {}:{}",
                      source, labels[static_cast<std::size_t>(i)], owner->second, object.name,
                      object.name, labels[static_cast<std::size_t>(i)]));
    }
  }
  return shares;
}

}  // namespace mmm_converter
