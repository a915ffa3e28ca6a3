// SPDX-License-Identifier: MIT
#include "common/label/learn/marker_names.h"

#include <array>
#include <set>
#include <string_view>

#include "common/io/recording/marker_labels.h"

namespace mmm_converter {
namespace {

struct SideWords {
  std::string_view left, right;
};
// Whole words before letters.
constexpr std::array<SideWords, 2> kSideWords = {{{"left", "right"}, {"l", "r"}}};

/// The side that a normalized label names by this word in this place, if its counterpart is there.
NamedSide SideBy(std::string_view label, const SideWords& words, bool at_end,
                 const std::set<std::string>& all) {
  const auto has = [&](std::string_view word) {
    return label.size() > word.size() && (at_end ? label.ends_with(word) : label.starts_with(word));
  };
  const auto other = [&](std::string_view word, std::string_view instead) {
    const std::string rest(at_end ? label.substr(0, label.size() - word.size())
                                  : label.substr(word.size()));
    return at_end ? rest + std::string(instead) : std::string(instead) + rest;
  };
  if (has(words.left) && all.contains(other(words.left, words.right))) return NamedSide::kLeft;
  if (has(words.right) && all.contains(other(words.right, words.left))) return NamedSide::kRight;
  return NamedSide::kNone;
}

}  // namespace

std::vector<NamedSide> NamedSides(const std::vector<std::string>& labels) {
  std::vector<std::string> normalized;
  normalized.reserve(labels.size());
  for (const std::string& label : labels) normalized.push_back(NormalizeLabel(label));
  const std::set<std::string> all(normalized.begin(), normalized.end());
  std::vector<NamedSide> sides;
  sides.reserve(labels.size());
  for (const std::string& label : normalized) {
    NamedSide side = NamedSide::kNone;
    for (const bool at_end : {false, true}) {
      for (const SideWords& words : kSideWords) {
        if (side == NamedSide::kNone) side = SideBy(label, words, at_end, all);
      }
    }
    sides.push_back(side);
  }
  return sides;
}

}  // namespace mmm_converter
