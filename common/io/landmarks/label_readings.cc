// SPDX-License-Identifier: MIT
#include "common/io/landmarks/label_readings.h"

#include <algorithm>
#include <cctype>
#include <set>
#include <utility>

namespace mmm_converter {
namespace {

constexpr std::size_t kLongestName = 60;  // names of landmarks are shorter
constexpr int kSeveral = 3;
constexpr BodySide kSides[] = {BodySide::kLeft, BodySide::kRight};

BodySide Other(BodySide side) {
  return side == BodySide::kLeft ? BodySide::kRight : BodySide::kLeft;
}

bool IsUpper(char c) { return c >= 'A' && c <= 'Z'; }
bool IsDigit(char c) { return c >= '0' && c <= '9'; }
/// In another alphabet than ASCII all are small.
bool IsLower(char c) { return (c >= 'a' && c <= 'z') || c < 0; }

/// "p:WaistLFront_study" is waist, l, front, study: apart where punctuation parts them, or small
/// from capital letters.
std::vector<std::string> WordsOfLabel(std::string_view label) {
  std::vector<std::string> words(1);
  for (std::size_t i = 0; i < label.size(); ++i) {
    const char c = label[i];
    const bool is_letter = IsUpper(c) || IsLower(c);
    const char before = i > 0 ? label[i - 1] : ' ';
    const char next = i + 1 < label.size() ? label[i + 1] : ' ';
    const bool is_new = (!is_letter && !IsDigit(c)) || (IsUpper(c) && IsLower(before)) ||
                        (IsUpper(c) && IsUpper(before) && IsLower(next));
    if (is_new && !words.back().empty()) words.emplace_back();
    if (is_letter || IsDigit(c)) {
      words.back() += static_cast<char>(IsUpper(c) ? c - 'A' + 'a' : c);
    }
  }
  if (words.back().empty()) words.pop_back();
  return words;
}

std::string JoinWords(const std::vector<std::string>& words, std::size_t without) {
  std::string whole;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i != without) whole += words[i];
  }
  return whole;
}

/// Numbers as "#".
std::string WithoutNumbers(const std::string& name) {
  std::string text;
  for (const char c : name) {
    if (!IsDigit(c)) text += c;
    if (IsDigit(c) && !text.ends_with('#')) text += '#';
  }
  return text;
}

struct Candidate {
  LabelReading reading;
  /// Names of the same on the other side; empty: it has no side, or a word says it.
  std::vector<std::string> counterparts = {};
  bool needs_counterpart = false;  ///< else it is wrong
};

/// Finds what a label can mean, and what that needs.
class LabelParser {
 public:
  LabelParser(std::string_view label, const LandmarkTable& table) : table_(table) {
    label = label.substr(label.rfind(':') + 1);
    if (label.size() > kLongestName) return;
    words_ = WordsOfLabel(label);
    is_computed_ = std::any_of(words_.begin(), words_.end(),
                               [&](const std::string& word) { return table_.IsComputed(word); });
    std::vector<std::string> said;
    for (std::size_t i = 0; i < words_.size(); ++i) {
      const bool may_leave = words_[i].size() > 1 || i == 0;
      if (!may_leave || !table_.IsLeftOut(words_[i])) said.push_back(words_[i]);
    }
    if (!said.empty()) words_ = std::move(said);
    whole_ = JoinWords(words_, words_.size());
  }

  bool is_computed() const { return is_computed_; }
  const std::string& whole() const { return whole_; }

  std::vector<Candidate> Candidates() {
    if (whole_.empty() || is_computed_) return {};
    Add(whole_, false, {});
    for (std::size_t i = 0; i < words_.size() && words_.size() > 1; ++i) AddSideWord(i);
    for (const BodySide side : kSides) AddAtEnd(side, false);
    for (const BodySide side : kSides) AddAtEnd(side, true);
    Add(whole_, true, {});
    if (found_.empty()) {
      for (const int landmark : table_.Find(WithoutNumbers(whole_), false)) {
        found_.push_back({{landmark, BodySide::kNone}});
      }
    }
    return std::move(found_);
  }

 private:
  void Add(const std::string& name, bool is_sided, Candidate candidate) {
    for (const int landmark : Meanings(name, is_sided)) {
      candidate.reading.landmark = landmark;
      const auto same = [&](const Candidate& one) { return one.reading == candidate.reading; };
      if (std::none_of(found_.begin(), found_.end(), same)) found_.push_back(candidate);
    }
  }

  std::vector<int> Meanings(const std::string& name, bool is_sided) const {
    std::vector<int> exact = table_.Find(name, is_sided);
    if (!exact.empty() || !is_sided) return exact;
    return table_.Find(WithoutNumbers(name), is_sided);
  }

  void AddSideWord(std::size_t i) {
    const std::string& word = words_[i];
    for (const BodySide side : kSides) {
      const auto& words = table_.side_words(side);
      if (std::find(words.begin(), words.end(), word) != words.end()) {
        Add(JoinWords(words_, i), true, {{-1, side}});
      }
      if (word.size() == 1 && table_.side_letters(side).find(word) != std::string::npos) {
        std::vector<std::string> counterparts;
        for (const char letter : table_.side_letters(Other(side))) {
          std::vector<std::string> other = words_;
          other[i] = letter;
          counterparts.push_back(JoinWords(other, other.size()));
        }
        Add(JoinWords(words_, i), true, {{-1, side}, counterparts, true});
      }
    }
  }

  void AddAtEnd(BodySide side, bool at_end) {
    for (const std::string& word : table_.side_words(side)) {
      if (whole_.size() <= word.size()) continue;
      if (at_end ? !whole_.ends_with(word) : !whole_.starts_with(word)) continue;
      const std::string rest =
          at_end ? whole_.substr(0, whole_.size() - word.size()) : whole_.substr(word.size());
      std::vector<std::string> counterparts;
      for (const std::string& other : table_.side_words(Other(side))) {
        counterparts.push_back(at_end ? rest + other : other + rest);
      }
      Add(rest, true, {{-1, side}, counterparts, at_end});
    }
  }

  const LandmarkTable& table_;
  std::vector<std::string> words_;
  std::string whole_;
  bool is_computed_ = false;
  std::vector<Candidate> found_;
};

/// "r asis#2": another point of the same name in its file.
bool IsCopy(const std::string& label) {
  const std::size_t mark = label.rfind('#');
  return mark != std::string::npos && mark > 0 && mark + 1 < label.size() &&
         std::all_of(label.begin() + static_cast<std::ptrdiff_t>(mark) + 1, label.end(), IsDigit);
}

/// The labels of a person on their way to one meaning each.
class LabelsOfPerson {
 public:
  LabelsOfPerson(const std::vector<std::string>& labels, const std::vector<bool>& seen,
                 const LandmarkTable& table)
      : table_(table), read_(labels.size()), is_used_(labels.size(), true) {
    std::vector<LabelParser> parsers;
    std::set<std::string> all;
    for (const std::string& label : labels) {
      parsers.emplace_back(label, table);
      all.insert(parsers.back().whole());
    }
    for (std::size_t i = 0; i < labels.size(); ++i) {
      if (!seen.empty() && !seen[i]) is_used_[i] = false;
      if (IsCopy(labels[i])) {
        read_[i].why_left_out = "another point of the same name";
      } else if (parsers[i].is_computed()) {
        read_[i].why_left_out = "a computed point";
      } else {
        Take(parsers[i], all, &read_[i]);
      }
      if (read_[i].readings.empty()) is_used_[i] = false;
    }
  }

  std::vector<ReadLabel> Read() {
    TakeAloneWithoutSide();
    SortReadings(AreKeypoints());
    TakeFree();
    LeaveOutJointsOfMarkers();
    return std::move(read_);
  }

 private:
  /// Readings that the other labels allow. LARM is no left arm where nothing begins with R and most
  /// labels have no side.
  void Take(LabelParser& parser, const std::set<std::string>& all, ReadLabel* label) {
    const std::string& whole = parser.whole();
    const bool is_lumbar = whole.size() == 2 && whole[0] == 'l' && IsDigit(whole[1]);
    bool has_side = false, is_alone = false;
    std::vector<LabelReading> without_side;
    for (const Candidate& one : parser.Candidates()) {
      const bool is_sided = table_.landmarks()[Index(one.reading)].is_sided;
      if (!is_sided && is_lumbar && all.contains("r" + whole.substr(1))) continue;
      const auto& others = one.counterparts;
      const bool has_other = std::any_of(others.begin(), others.end(),
                                         [&](const auto& other) { return all.contains(other); });
      if (one.needs_counterpart && !has_other) continue;
      if (is_sided && one.reading.side == BodySide::kNone) {
        without_side.push_back(one.reading);
        continue;
      }
      label->readings.push_back(one.reading);
      has_side |= is_sided;
      is_alone |= !others.empty() && !has_other;
    }
    if (!has_side && label->readings.empty()) {
      if (!without_side.empty()) ++num_without_side_;
      label->readings = std::move(without_side);
    } else if (is_alone && !without_side.empty()) {
      alone_.emplace_back(label, without_side);
    }
  }

  void TakeAloneWithoutSide() {
    if (num_without_side_ < kSeveral) return;
    for (auto& [label, readings] : alone_) label->readings = std::move(readings);
  }

  static std::size_t Index(const LabelReading& reading) {
    return static_cast<std::size_t>(reading.landmark);
  }

  LandmarkKind KindOf(const LabelReading& reading) const {
    return table_.landmarks()[Index(reading)].kind;
  }

  bool HasKind(const ReadLabel& label, LandmarkKind kind) const {
    return std::any_of(label.readings.begin(), label.readings.end(),
                       [&](const auto& reading) { return KindOf(reading) == kind; });
  }

  /// Joints by name, and nothing that only a marker can be on but the head and the feet.
  bool AreKeypoints() const {
    int joints = 0;
    for (std::size_t i = 0; i < read_.size(); ++i) {
      if (!is_used_[i]) continue;
      const ReadLabel& label = read_[i];
      joints += HasKind(label, LandmarkKind::kJoint) ? 1 : 0;
      const bool may_be_keypoint =
          HasKind(label, LandmarkKind::kJoint) || HasKind(label, LandmarkKind::kPoint);
      const std::string& part = table_.landmarks()[Index(label.readings[0])].part;
      if (!may_be_keypoint && part != "head" && part != "foot" && part != "hand") return false;
    }
    return joints >= 4;
  }

  void SortReadings(bool are_keypoints) {
    for (ReadLabel& label : read_) {
      std::stable_sort(label.readings.begin(), label.readings.end(),
                       [&](const auto& a, const auto& b) {
                         const bool a_is_joint = KindOf(a) == LandmarkKind::kJoint;
                         const bool b_is_joint = KindOf(b) == LandmarkKind::kJoint;
                         return a_is_joint != b_is_joint && a_is_joint == are_keypoints;
                       });
    }
  }

  /// Of several readings, the first that no label without choice has.
  void TakeFree() {
    std::set<std::pair<int, BodySide>> taken;
    const auto key = [](const LabelReading& one) { return std::pair(one.landmark, one.side); };
    for (std::size_t i = 0; i < read_.size(); ++i) {
      if (is_used_[i] && read_[i].readings.size() == 1) taken.insert(key(read_[i].readings[0]));
    }
    for (std::size_t i = 0; i < read_.size(); ++i) {
      auto& readings = read_[i].readings;
      if (!is_used_[i] || readings.size() < 2) continue;
      const auto free =
          std::stable_partition(readings.begin(), readings.end(), [&](const auto& one) {
            return KindOf(one) == LandmarkKind::kSegment || !taken.contains(key(one));
          });
      if (free != readings.begin()) taken.insert(key(readings[0]));
    }
  }

  /// A joint's centre tells nothing beside markers on both of its sides, of which it was computed.
  void LeaveOutJointsOfMarkers() {
    const auto count = [&](const std::string& part, BodySide side) {
      int markers = 0;
      for (std::size_t i = 0; i < read_.size(); ++i) {
        if (!is_used_[i] || !read_[i].why_left_out.empty()) continue;
        const LabelReading& one = read_[i].readings[0];
        const Landmark& landmark = table_.landmarks()[Index(one)];
        const bool is_there = landmark.part == part && landmark.kind == LandmarkKind::kSkin &&
                              (part == "pelvis" || one.side == side);
        markers += is_there ? 1 : 0;
      }
      return markers;
    };
    for (std::size_t i = 0; i < read_.size(); ++i) {
      if (!is_used_[i] || KindOf(read_[i].readings[0]) != LandmarkKind::kJoint) continue;
      const LabelReading& one = read_[i].readings[0];
      const std::string& part = table_.landmarks()[Index(one)].part;
      if (part == "head" || part == "neck" || part == "thorax") continue;
      if (count(part, one.side) >= (part == "pelvis" ? 3 : 1)) {
        read_[i].why_left_out = "a joint's centre beside its markers";
      }
    }
  }

  const LandmarkTable& table_;
  std::vector<ReadLabel> read_;
  std::vector<bool> is_used_;
  int num_without_side_ = 0;  ///< labels that tell the side of no sided landmark
  /// Whose side may be a part of their name, and what they mean then.
  std::vector<std::pair<ReadLabel*, std::vector<LabelReading>>> alone_;
};

}  // namespace

std::vector<LabelReading> ReadingsOf(std::string_view label, const LandmarkTable& table) {
  std::vector<LabelReading> readings;
  for (const Candidate& one : LabelParser(label, table).Candidates()) {
    if (!one.needs_counterpart) readings.push_back(one.reading);
  }
  return readings;
}

std::vector<ReadLabel> ReadLabels(const std::vector<std::string>& labels,
                                  const std::vector<bool>& seen, const LandmarkTable& table) {
  return LabelsOfPerson(labels, seen, table).Read();
}

}  // namespace mmm_converter
