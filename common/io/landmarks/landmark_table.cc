// SPDX-License-Identifier: MIT
#include "common/io/landmarks/landmark_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "common/io/xml/xml_document.h"
#include "common/support/data_directory.h"
#include "common/support/diagnostics.h"
#include "common/support/error.h"
#include "common/support/text.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

constexpr std::pair<const char*, LandmarkKind> kKinds[] = {{"skin", LandmarkKind::kSkin},
                                                           {"point", LandmarkKind::kPoint},
                                                           {"joint", LandmarkKind::kJoint},
                                                           {"segment", LandmarkKind::kSegment}};
constexpr double kFarthestLandmark = 10;  // [m]; no segment is longer
constexpr double kSmallestSpread = 1;     // [mm]
constexpr double kLargestSpread = 1000;   // [mm]
constexpr std::size_t kMostSpellings = 200'000;
// Words that stand for any number, and for a letter of a series.
constexpr const char* kNumber = "n";
constexpr const char* kSeries = "abc";

std::vector<std::string> SplitWords(std::string_view text) {
  std::vector<std::string> words;
  std::string word;
  for (const char c : text) {
    const bool is_blank = c == ' ' || c == '\n' || c == '\t' || c == '\r';
    if (!is_blank) word += c;
    if (is_blank && !word.empty()) words.push_back(std::move(word)), word.clear();
  }
  if (!word.empty()) words.push_back(std::move(word));
  return words;
}

/// Reads elements of a file; what is wrong becomes an error of the file.
class LandmarkReader {
 public:
  explicit LandmarkReader(const std::string& path) : diagnostics_(path) {}

  Diagnostics& diagnostics() { return diagnostics_; }

  void Check(const XmlElement& element, const std::vector<std::string>& allowed) {
    const std::vector<std::string> others = element.AttributesBeside(allowed);
    for (const std::string& other : others) {
      Fail(element, fmt::format("<{}> has no attribute {}; allowed are {}", element.name, other,
                                fmt::join(allowed, ", ")));
    }
  }

  std::string Text(const XmlElement& element, const char* attribute) {
    const std::string* value = element.FindAttribute(attribute);
    if (value != nullptr && !Trim(*value).empty()) return std::string(Trim(*value));
    Fail(element, fmt::format("<{}> needs the attribute {}", element.name, attribute));
    return "";
  }

  double Number(const XmlElement& element, const char* attribute, double least, double most) {
    const std::string text = Text(element, attribute);
    const double value = ParseDouble(text).value_or(kNaN);
    if (!text.empty() && !(value >= least && value <= most)) {
      Fail(element, fmt::format("{}=\"{}\": must be a number of mm from {} to {}", attribute, text,
                                least, most));
    }
    return value / kMillimetres;
  }

  /// Spellings with each {word} replaced by each of its spellings.
  std::vector<std::string> Spellings(const XmlElement& element) {
    std::vector<std::string> all;
    for (const std::string& one : SplitWords(element.text)) Expand(element, one, &all);
    return all;
  }

  void AddWord(const XmlElement& element) {
    Check(element, {"name", "spellings"});
    words_[Text(element, "name")] = SplitWords(Text(element, "spellings"));
  }

  std::vector<std::string> words() const {
    std::vector<std::string> all;
    for (const auto& [name, spellings] : words_) {
      if (name != kNumber && name != kSeries)
        all.insert(all.end(), spellings.begin(), spellings.end());
    }
    return all;
  }

  void Fail(const XmlElement& element, const std::string& message) {
    diagnostics_.AddError(element.line, message);
  }

 private:
  void Expand(const XmlElement& element, const std::string& spelling,
              std::vector<std::string>* all) {
    const std::size_t open = spelling.find('{');
    if (open == std::string::npos) {
      CheckSpelling(element, spelling);
      if (++count_ > kMostSpellings) {
        throw Error(
            fmt::format("{}: has more than {} spellings", diagnostics_.file(), kMostSpellings));
      }
      all->push_back(spelling);
      return;
    }
    const std::size_t close = spelling.find('}', open);
    const std::string name =
        close == std::string::npos ? "" : spelling.substr(open + 1, close - open - 1);
    const auto word = words_.find(name);
    if (word == words_.end()) {
      Fail(element, fmt::format("\"{}\": there is no <Word> of that name above it", spelling));
      return;
    }
    for (const std::string& one : word->second) {
      Expand(element, spelling.substr(0, open) + one + spelling.substr(close + 1), all);
    }
  }

  void CheckSpelling(const XmlElement& element, const std::string& spelling) {
    const bool is_right = std::all_of(spelling.begin(), spelling.end(), [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c < 0 || c == '#' || c == '@';
    });
    if (is_right) return;
    Fail(element, fmt::format("\"{}\": spellings are in small letters and digits", spelling));
  }

  Diagnostics diagnostics_;
  std::map<std::string, std::vector<std::string>> words_ = {{kNumber, {"#"}}, {kSeries, {"@"}}};
  std::size_t count_ = 0;
};

Landmark ReadLandmark(const XmlElement& element, LandmarkReader* reader) {
  reader->Check(element, {"name", "kind", "part", "sided", "marker", "segment", "x_mm", "y_mm",
                          "z_mm", "deviation_mm", "bones"});
  Landmark landmark;
  landmark.name = reader->Text(element, "name");
  landmark.part = reader->Text(element, "part");
  const std::string kind = reader->Text(element, "kind");
  const auto found = std::find_if(std::begin(kKinds), std::end(kKinds),
                                  [&](const auto& one) { return one.first == kind; });
  if (found != std::end(kKinds)) landmark.kind = found->second;
  if (found == std::end(kKinds) && !kind.empty()) {
    reader->Fail(element, fmt::format("kind=\"{}\": must be skin, point, joint or segment", kind));
  }
  if (const std::string* sided = element.FindAttribute("sided")) {
    landmark.is_sided = *sided == "true";
    if (*sided != "true" && *sided != "false") {
      reader->Fail(element, fmt::format("sided=\"{}\": must be true or false", *sided));
    }
  }
  landmark.deviation = reader->Number(element, "deviation_mm", kSmallestSpread, kLargestSpread);
  if (element.FindAttribute("marker") != nullptr) {
    landmark.marker = reader->Text(element, "marker");
    if (element.FindAttribute("segment") == nullptr) return landmark;
  }
  const double most = kMillimetres * kFarthestLandmark;
  landmark.segment = reader->Text(element, "segment");
  landmark.p_SM.x() = reader->Number(element, "x_mm", -most, most);
  landmark.p_SM.y() = reader->Number(element, "y_mm", -most, most);
  landmark.p_SM.z() = reader->Number(element, "z_mm", -most, most);
  return landmark;
}

void SortByLength(std::vector<std::string>* words) {
  std::stable_sort(words->begin(), words->end(),
                   [](const auto& a, const auto& b) { return a.size() > b.size(); });
}

}  // namespace

LandmarkTable::LandmarkTable(const std::string& path) : file_(path) {
  const XmlElement root = ReadXmlFile(path);
  LandmarkReader reader(path);
  if (!root.Is("Landmarks")) {
    reader.Fail(root, fmt::format("<{}>: expected <Landmarks>", root.name));
    reader.diagnostics().ThrowIfErrors();
  }
  std::set<std::string> names;
  for (const XmlElement& child : root.children) {
    if (child.Is("Side")) {
      reader.Check(child, {"left", "right", "leftLetters", "rightLetters"});
      left_ = SplitWords(reader.Text(child, "left"));
      right_ = SplitWords(reader.Text(child, "right"));
      for (const auto& word : SplitWords(reader.Text(child, "leftLetters"))) left_letters_ += word;
      for (const auto& word : SplitWords(reader.Text(child, "rightLetters")))
        right_letters_ += word;
    } else if (child.Is("Leave") || child.Is("Computed")) {
      reader.Check(child, {"words"});
      (child.Is("Leave") ? leave_ : computed_) = SplitWords(reader.Text(child, "words"));
    } else if (child.Is("Word")) {
      reader.AddWord(child);
    } else if (child.Is("Landmark")) {
      landmarks_.push_back(ReadLandmark(child, &reader));
      if (!names.insert(landmarks_.back().name).second) {
        reader.Fail(child, fmt::format("landmark {} is there twice", landmarks_.back().name));
      }
      const int index = static_cast<int>(landmarks_.size()) - 1;
      auto& spellings = landmarks_.back().is_sided ? sided_ : middle_;
      for (const std::string& one : reader.Spellings(child)) {
        std::vector<int>& meanings = spellings[one];
        if (meanings.empty() || meanings.back() != index) meanings.push_back(index);
      }
      const std::string* bones = child.FindAttribute("bones");
      auto& of_bones = landmarks_.back().is_sided ? sided_bones_ : middle_bones_;
      for (const auto& bone : SplitWords(bones ? *bones : "")) of_bones[bone].push_back(index);
    } else {
      reader.Fail(child, fmt::format("<{}>: only <Side>, <Leave>, <Computed>, <Word> and "
                                     "<Landmark> are allowed here",
                                     child.name));
    }
  }
  if (landmarks_.empty()) reader.Fail(root, "there is no <Landmark>");
  reader.diagnostics().ThrowIfErrors();
  place_words_ = reader.words();
  SortByLength(&place_words_);
  SortByLength(&left_);
  SortByLength(&right_);
}

const std::vector<int>& LandmarkTable::Find(const Meanings& meanings, const std::string& spelling) {
  static const std::vector<int> none;
  const auto found = meanings.find(spelling);
  return found == meanings.end() ? none : found->second;
}

const std::vector<int>& LandmarkTable::Find(const std::string& spelling, bool is_sided) const {
  return Find(is_sided ? sided_ : middle_, spelling);
}

const std::vector<int>& LandmarkTable::FindBone(const std::string& spelling, bool is_sided) const {
  return Find(is_sided ? sided_bones_ : middle_bones_, spelling);
}

const std::vector<std::string>& LandmarkTable::side_words(BodySide side) const {
  return side == BodySide::kLeft ? left_ : right_;
}

const std::string& LandmarkTable::side_letters(BodySide side) const {
  return side == BodySide::kLeft ? left_letters_ : right_letters_;
}

bool LandmarkTable::Contains(const std::vector<std::string>& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

const LandmarkTable& ShippedLandmarks() {
  static const LandmarkTable table(DataFile("landmarks.xml"));
  return table;
}

}  // namespace mmm_converter
