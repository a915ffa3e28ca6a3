// SPDX-License-Identifier: MIT
#include "common/io/skeleton/bone_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "common/io/xml/xml_document.h"
#include "common/support/data_directory.h"
#include "common/support/diagnostics.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

constexpr std::pair<const char*, BoneKind> kKinds[] = {
    {"hip", BoneKind::kHip},           {"leg", BoneKind::kLeg},
    {"knee", BoneKind::kKnee},         {"ankle", BoneKind::kAnkle},
    {"foot", BoneKind::kFoot},         {"toe", BoneKind::kToe},
    {"collar", BoneKind::kCollar},     {"shoulder", BoneKind::kShoulder},
    {"upperarm", BoneKind::kUpperArm}, {"arm", BoneKind::kArm},
    {"elbow", BoneKind::kElbow},       {"wrist", BoneKind::kWrist},
    {"hand", BoneKind::kHand},         {"neck", BoneKind::kNeck},
    {"head", BoneKind::kHead}};
constexpr std::size_t kLongestName = 100;

bool IsUpper(char c) { return c >= 'A' && c <= 'Z'; }
bool IsLower(char c) { return (c >= 'a' && c <= 'z') || c < 0; }

bool Contains(const std::vector<std::string>& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// "Bip01 L UpperArm" is bip, l, upper, arm: numbers tell nothing.
std::vector<std::string> WordsOfName(std::string_view name) {
  std::vector<std::string> words(1);
  for (std::size_t i = 0; i < name.size(); ++i) {
    const char c = name[i];
    const char before = i > 0 ? name[i - 1] : ' ';
    const char next = i + 1 < name.size() ? name[i + 1] : ' ';
    const bool is_letter = IsUpper(c) || IsLower(c);
    const bool is_new = !is_letter || (IsUpper(c) && IsLower(before)) ||
                        (IsUpper(c) && IsUpper(before) && IsLower(next));
    if (is_new && !words.back().empty()) words.emplace_back();
    if (is_letter) words.back() += static_cast<char>(IsUpper(c) ? c - 'A' + 'a' : c);
  }
  if (words.back().empty()) words.pop_back();
  return words;
}

std::vector<std::string> WordsOfText(const std::string& text) {
  std::vector<std::string> words;
  std::string word;
  for (const char c : text + ' ') {
    const bool is_blank = c == ' ' || c == '\n' || c == '\t' || c == '\r';
    if (!is_blank) word += c;
    if (is_blank && !word.empty()) words.push_back(std::exchange(word, ""));
  }
  return words;
}

std::vector<std::string> WordsIn(const XmlElement& element, const char* attribute,
                                 Diagnostics* diagnostics) {
  const std::string* text = element.FindAttribute(attribute);
  std::vector<std::string> words = WordsOfText(text != nullptr ? *text : "");
  if (words.empty()) {
    diagnostics->AddError(element.line,
                          fmt::format("<{}> needs the attribute {}", element.name, attribute));
  }
  return words;
}

}  // namespace

BoneNames::BoneNames(const std::string& path) {
  const XmlElement root = ReadXmlFile(path);
  Diagnostics diagnostics(path);
  if (!root.Is("Bones")) {
    diagnostics.AddError(root.line, fmt::format("<{}>: expected <Bones>", root.name));
    diagnostics.ThrowIfErrors();
  }
  for (const XmlElement& child : root.children) {
    if (child.Is("Side")) {
      sides_[0] = WordsIn(child, "left", &diagnostics);
      sides_[1] = WordsIn(child, "right", &diagnostics);
    } else if (child.Is("Leave")) {
      leave_ = WordsIn(child, "words", &diagnostics);
    } else if (child.Is("NoBone")) {
      no_bone_ = WordsIn(child, "words", &diagnostics);
    } else if (child.Is("Bone")) {
      const std::string* kind = child.FindAttribute("kind");
      const auto known = std::find_if(std::begin(kKinds), std::end(kKinds), [&](const auto& one) {
        return kind != nullptr && *kind == one.first;
      });
      if (known == std::end(kKinds)) {
        diagnostics.AddError(child.line,
                             "<Bone>: its kind must be hip, leg, knee, ankle, foot, toe, "
                             "collar, shoulder, upperarm, arm, elbow, wrist, hand, neck "
                             "or head");
        continue;
      }
      for (const std::string& spelling : WordsOfText(child.text)) {
        if (kinds_.emplace(spelling, known->second).second) continue;
        diagnostics.AddError(child.line, fmt::format("{} is there twice", spelling));
      }
    } else {
      diagnostics.AddError(child.line,
                           fmt::format("<{}>: only <Side>, <Leave>, <NoBone> and <Bone> "
                                       "are allowed here",
                                       child.name));
    }
  }
  diagnostics.ThrowIfErrors();
}

BoneKind BoneNames::KindOf(const std::vector<std::string>& words, bool is_whole) const {
  std::vector<std::string> said;
  for (const std::string& word : words) {
    if (Contains(no_bone_, word)) return BoneKind::kNone;
    if (!Contains(leave_, word)) said.push_back(word);
  }
  // Before the bone there may be a name of the whole skeleton: "f_avg_L_Shoulder".
  for (std::size_t first = 0; first < (is_whole ? 1 : said.size()); ++first) {
    std::string spelling;
    for (std::size_t i = first; i < said.size(); ++i) spelling += said[i];
    const auto found = kinds_.find(spelling);
    if (found != kinds_.end()) return found->second;
  }
  return BoneKind::kNone;
}

BoneName BoneNames::FindInWords(const std::vector<std::string>& words) const {
  if (std::any_of(words.begin(), words.end(),
                  [&](const std::string& word) { return Contains(no_bone_, word); })) {
    return {};
  }
  for (std::size_t i = 0; i < words.size(); ++i) {
    for (const int side : {0, 1}) {
      for (const std::string& of_side : sides_[side]) {
        if (words[i].size() <= of_side.size()) continue;
        if (words[i].starts_with(of_side)) {
          std::vector<std::string> rest(words.begin() + static_cast<std::ptrdiff_t>(i),
                                        words.end());
          rest.front().erase(0, of_side.size());
          const BoneKind kind = KindOf(rest, true);
          if (kind != BoneKind::kNone) return {kind, "LR"[side]};
        }
        if (i + 1 == words.size() && words[i].ends_with(of_side)) {
          std::vector<std::string> rest = words;
          rest.back().resize(rest.back().size() - of_side.size());
          const BoneKind kind = KindOf(rest, false);
          if (kind != BoneKind::kNone) return {kind, "LR"[side]};
        }
      }
    }
  }
  return {};
}

BoneName BoneNames::Find(std::string_view joint) const {
  joint = joint.substr(joint.rfind(':') + 1);
  if (joint.size() > kLongestName) return {};
  const std::vector<std::string> words = WordsOfName(joint);
  for (std::size_t i = 0; i < words.size(); ++i) {
    for (const int side : {0, 1}) {
      if (!Contains(sides_[side], words[i])) continue;
      std::vector<std::string> rest = words;
      rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(i));
      return {KindOf(rest, false), "LR"[side]};
    }
  }
  // The side is a part of a word: "lfemur", "LUArm", "footl".
  const BoneName sided = FindInWords(words);
  return sided.kind != BoneKind::kNone ? sided : BoneName{KindOf(words, false), ' '};
}

const BoneNames& ShippedBoneNames() {
  static const BoneNames names(DataFile("bones.xml"));
  return names;
}

}  // namespace mmm_converter
