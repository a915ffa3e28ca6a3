// SPDX-License-Identifier: MIT
#include "common/io/landmarks/label_readings.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

namespace mmm_converter {
namespace {

/// A meaning of a label, and what it needs to be right.
struct Candidate {
  LabelReading reading;
  /// Names of the same on the other side; empty: it has no side, or a word says it.
  std::vector<std::string> counterparts = {};
  bool needs_counterpart = false;  ///< else it is wrong
  std::size_t side_length = 0;     ///< of what says it, where that is a part of a word
};

/// Finds what a label can mean, and what that needs.
class LabelParser {
 public:
  /// prefix: words that all names of a file begin with, of no meaning here.
  LabelParser(std::string_view label, const LandmarkTable& table,
              const std::vector<std::string>& prefix = {});

  bool is_computed() const { return is_computed_; }
  /// The name without what tells nothing, in small letters and digits.
  const std::string& whole() const { return whole_; }

  std::vector<Candidate> Candidates();
  /// As one of a series of letters, "RFMA" to "RFMD": what its name without the letter means.
  std::vector<Candidate> OfSeries();
  /// What it means if it is the name of a skeleton's bone: the joint that this begins at.
  std::vector<LabelReading> Bones();

 private:
  void AddAll();
  void Add(const std::string& name, bool is_sided, Candidate candidate);
  std::vector<int> Meanings(const std::string& name, bool is_sided) const;
  /// Where on a segment a marker of a cluster is worn may be said in any words: "thighpostsup2".
  std::vector<int> SegmentsOf(const std::string& name, bool is_sided, int num_words) const;
  void AddSideWord(std::size_t i);
  void AddAtEnd(BodySide side, bool at_end);
  /// The side is one letter of the name: "MLG" and "MLD", "FRTHI" and "FLTHI".
  void AddLetter(std::size_t at);
  /// The part of the body that a segment's name means; empty: it is none.
  std::string PartOf(const std::string& word) const;
  /// "pelvis-RASIS", "Foot_R_Heel": the segment is said, too.
  void AddBesideSegment();
  /// Single letters that stand for a side in any language.
  std::string LettersOf(BodySide side) const;

  const LandmarkTable& table_;
  std::vector<std::string> words_;
  std::string whole_;
  bool is_computed_ = false;
  enum class Looking { kAnywhere, kAtSegments, kAtBones, kAtSeries };
  Looking looking_ = Looking::kAnywhere;
  std::vector<Candidate> found_;
};

constexpr int kMostPlaceWords = 4;
constexpr std::size_t kLongestName = 60;  // names of landmarks are shorter
constexpr BodySide kSides[] = {BodySide::kLeft, BodySide::kRight};

BodySide Other(BodySide side) {
  return side == BodySide::kLeft ? BodySide::kRight : BodySide::kLeft;
}

bool IsUpper(char c) { return c >= 'A' && c <= 'Z'; }
bool IsDigit(char c) { return c >= '0' && c <= '9'; }
/// In another alphabet than ASCII all are small.
bool IsLower(char c) { return (c >= 'a' && c <= 'z') || c < 0; }

/// The letter without its accent, of the Latin ones that UTF-8 writes as 0xC3 and this byte; empty:
/// it is none.
std::string_view WithoutAccent(char second) {
  constexpr std::string_view kBare[] = {"a", "a", "a", "a", "a", "a", "ae", "c", "e", "e", "e",
                                        "e", "i", "i", "i", "i", "",  "n",  "o", "o", "o", "o",
                                        "o", "",  "o", "u", "u", "u", "u",  "y", "",  "ss"};
  const auto code = static_cast<unsigned char>(second);
  if (code < 0x80 || code >= 0xC0) return {};
  return kBare[code % 32];
}

/// "Épaule" as "Epaule".
std::string WithoutAccents(std::string_view label) {
  std::string bare;
  for (std::size_t i = 0; i < label.size(); ++i) {
    const bool may_be = label[i] == '\xC3' && i + 1 < label.size();
    const std::string_view letter = may_be ? WithoutAccent(label[i + 1]) : std::string_view();
    if (letter.empty()) {
      bare += label[i];
      continue;
    }
    const bool is_capital = static_cast<unsigned char>(label[++i]) < 0x9F;
    bare += is_capital ? static_cast<char>(letter[0] - 'a' + 'A') : letter[0];
    bare += letter.substr(1);
  }
  return bare;
}

/// "p:WaistLFront_study" is waist, l, front, study: apart where punctuation parts them, or small
/// from capital letters.
std::vector<std::string> WordsOfLabel(std::string_view written) {
  const std::string label = WithoutAccents(written);
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

LabelParser::LabelParser(std::string_view label, const LandmarkTable& table,
                         const std::vector<std::string>& prefix)
    : table_(table) {
  label = label.substr(label.rfind(':') + 1);
  if (label.size() > kLongestName) return;
  words_ = WordsOfLabel(label);
  if (words_.size() > prefix.size() && std::equal(prefix.begin(), prefix.end(), words_.begin())) {
    words_.erase(words_.begin(), words_.begin() + static_cast<std::ptrdiff_t>(prefix.size()));
  }
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

std::vector<Candidate> LabelParser::Candidates() {
  if (whole_.empty() || is_computed_) return {};
  AddAll();
  for (std::size_t at = 1; at + 1 < whole_.size() && found_.empty(); ++at) AddLetter(at);
  if (found_.empty()) AddLetter(0);
  if (found_.empty()) AddBesideSegment();
  if (found_.empty()) {
    looking_ = Looking::kAtSegments;
    AddAll();
    looking_ = Looking::kAnywhere;
  }
  if (found_.empty()) {
    for (const int landmark : table_.Find(WithoutNumbers(whole_), false)) {
      found_.push_back({{landmark, BodySide::kNone}});
    }
  }
  return std::move(found_);
}

std::vector<Candidate> LabelParser::OfSeries() {
  if (whole_.size() < 2) return {};
  const std::vector<std::string> words = words_;
  const std::string whole = whole_;
  words_.back().pop_back();
  if (words_.back().empty()) words_.pop_back();
  whole_.pop_back();
  found_.clear();
  looking_ = Looking::kAtSeries;
  AddAll();
  looking_ = Looking::kAnywhere;
  words_ = words;
  whole_ = whole;
  for (Candidate& one : found_) {
    for (std::string& counterpart : one.counterparts) counterpart += whole.back();
  }
  return std::move(found_);
}

std::vector<LabelReading> LabelParser::Bones() {
  if (whole_.empty() || is_computed_) return {};
  found_.clear();
  looking_ = Looking::kAtBones;
  AddAll();
  looking_ = Looking::kAnywhere;
  std::vector<LabelReading> bones;
  for (const Candidate& one : found_) {
    const bool is_sided =
        table_.landmarks()[static_cast<std::size_t>(one.reading.landmark)].is_sided;
    const bool has_side = one.reading.side != BodySide::kNone;
    if (!one.needs_counterpart && is_sided == has_side) bones.push_back(one.reading);
  }
  found_.clear();
  return bones;
}

void LabelParser::AddAll() {
  Add(whole_, false, {});
  for (std::size_t i = 0; i < words_.size() && words_.size() > 1; ++i) AddSideWord(i);
  for (const BodySide side : kSides) AddAtEnd(side, false);
  for (const BodySide side : kSides) AddAtEnd(side, true);
  AddLetter(whole_.size() - 1);
  Add(whole_, true, {});
}

void LabelParser::Add(const std::string& name, bool is_sided, Candidate candidate) {
  for (const int landmark : Meanings(name, is_sided)) {
    candidate.reading.landmark = landmark;
    const auto same = [&](const Candidate& one) { return one.reading == candidate.reading; };
    if (std::none_of(found_.begin(), found_.end(), same)) found_.push_back(candidate);
  }
}

std::vector<int> LabelParser::Meanings(const std::string& name, bool is_sided) const {
  if (looking_ == Looking::kAtSegments) return SegmentsOf(name, is_sided, 0);
  if (looking_ == Looking::kAtBones) return table_.FindBone(name, is_sided);
  if (looking_ == Looking::kAtSeries) {
    std::vector<int> segments = table_.Find(name + '@', is_sided);
    for (const std::string& spelling : {name, name + '#'}) {
      if (segments.empty()) segments = SegmentsOf(spelling, is_sided, kMostPlaceWords);
    }
    return segments;
  }
  std::vector<int> exact = table_.Find(name, is_sided);
  if (!exact.empty() || !is_sided) return exact;
  return table_.Find(WithoutNumbers(name), is_sided);
}

std::vector<int> LabelParser::SegmentsOf(const std::string& name, bool is_sided,
                                         int num_words) const {
  constexpr std::size_t kShortest = 3;  // shorter ones are parts of other words
  std::vector<int> segments;
  for (const int landmark : table_.Find(name, is_sided)) {
    const auto kind = table_.landmarks()[static_cast<std::size_t>(landmark)].kind;
    if (kind == LandmarkKind::kSegment) segments.push_back(landmark);
  }
  if (!segments.empty() || num_words == kMostPlaceWords) return segments;
  const std::size_t number = name.find_last_not_of("0123456789") + 1;
  if (number > 0 && number < name.size()) {
    return SegmentsOf(name.substr(0, number), is_sided, num_words + 1);
  }
  for (const std::string& word : table_.place_words()) {
    if (word.size() < kShortest || name.size() <= word.size()) continue;
    const std::size_t rest = name.size() - word.size();
    if (name.ends_with(word)) segments = SegmentsOf(name.substr(0, rest), is_sided, num_words + 1);
    if (segments.empty() && name.starts_with(word)) {
      segments = SegmentsOf(name.substr(word.size()), is_sided, num_words + 1);
    }
    if (!segments.empty()) break;
  }
  return segments;
}

void LabelParser::AddSideWord(std::size_t i) {
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

void LabelParser::AddAtEnd(BodySide side, bool at_end) {
  for (const std::string& word : table_.side_words(side)) {
    if (whole_.size() <= word.size()) continue;
    if (at_end ? !whole_.ends_with(word) : !whole_.starts_with(word)) continue;
    const std::string rest =
        at_end ? whole_.substr(0, whole_.size() - word.size()) : whole_.substr(word.size());
    std::vector<std::string> counterparts;
    for (const std::string& other : table_.side_words(Other(side))) {
      counterparts.push_back(at_end ? rest + other : other + rest);
    }
    Add(rest, true, {{-1, side}, counterparts, at_end, word.size()});
  }
}

void LabelParser::AddLetter(std::size_t at) {
  const std::string before = whole_.substr(0, at), after = whole_.substr(at + 1);
  for (const BodySide side : kSides) {
    if (LettersOf(side).find(whole_[at]) == std::string::npos) continue;
    std::vector<std::string> counterparts;
    for (const char letter : LettersOf(Other(side))) {
      std::string& counterpart = counterparts.emplace_back(whole_);
      counterpart[at] = letter;
    }
    Add(before + after, true, {{-1, side}, counterparts, true, 1});
  }
}

std::string LabelParser::PartOf(const std::string& word) const {
  for (const Landmark& one : table_.landmarks()) {
    if (one.part == word) return word;
  }
  const std::vector<int> segments = SegmentsOf(word, true, kMostPlaceWords);
  return segments.empty() ? "" : table_.landmarks()[static_cast<std::size_t>(segments[0])].part;
}

void LabelParser::AddBesideSegment() {
  const std::vector<std::string> words = words_;
  const std::string whole = whole_;
  for (std::size_t i = 0; i < words.size() && words.size() > 1 && found_.empty(); ++i) {
    const std::string part = PartOf(words[i]);
    if (part.empty()) continue;
    words_ = words;
    words_.erase(words_.begin() + static_cast<std::ptrdiff_t>(i));
    whole_ = JoinWords(words_, words_.size());
    AddAll();
    std::erase_if(found_, [&](const Candidate& one) {
      const std::string& of =
          table_.landmarks()[static_cast<std::size_t>(one.reading.landmark)].part;
      return of != part && !(of == "ankle" && (part == "shank" || part == "foot"));
    });
  }
  words_ = words;
  whole_ = whole;
}

std::string LabelParser::LettersOf(BodySide side) const {
  return (side == BodySide::kLeft ? "l" : "r") + table_.side_letters(side);
}

/// Words that nearly all names begin with, as "Body_RKnee" and "251112_KUO_LASI".
std::vector<std::string> CommonPrefix(const std::vector<std::string>& labels) {
  constexpr double kNearlyAll = 0.9;
  constexpr std::size_t kFewest = 4;
  std::vector<std::string> prefix;
  std::vector<std::vector<std::string>> names;
  for (const std::string& label : labels) {
    if (label.size() <= kLongestName) names.push_back(WordsOfLabel(label));
  }
  while (names.size() >= kFewest) {
    std::map<std::string, std::size_t> first;
    for (const auto& words : names) {
      if (words.size() > prefix.size() + 1) ++first[words[prefix.size()]];
    }
    const auto most =
        std::max_element(first.begin(), first.end(),
                         [](const auto& a, const auto& b) { return a.second < b.second; });
    if (most == first.end() || static_cast<double>(most->second) < kNearlyAll * names.size()) break;
    prefix.push_back(most->first);
  }
  return prefix;
}

constexpr int kSeveral = 3;

enum class Limbs { kNone, kArms, kLegs };

Limbs LimbsOf(const std::string& part) {
  for (const char* one : {"upper arm", "forearm", "hand"}) {
    if (part == one) return Limbs::kArms;
  }
  for (const char* one : {"thigh", "shank", "ankle", "foot"}) {
    if (part == one) return Limbs::kLegs;
  }
  return Limbs::kNone;
}

/// "r asis#2": another point of the same name in its file.
bool IsCopy(const std::string& label) {
  const std::size_t mark = label.rfind('#');
  return mark != std::string::npos && mark > 0 && mark + 1 < label.size() &&
         std::all_of(label.begin() + static_cast<std::ptrdiff_t>(mark) + 1, label.end(),
                     [](char c) { return c >= '0' && c <= '9'; });
}

/// Origin and axes of a segment, stored as points: "LTIO", "LTIA", "LTIL" and "LTIP".
bool IsOfAxes(const std::string& name, const std::set<std::string>& all) {
  constexpr std::string_view kEnds = "oalp";
  if (name.size() != 4 || kEnds.find(name.back()) == std::string_view::npos) return false;
  return std::all_of(kEnds.begin(), kEnds.end(),
                     [&](char end) { return all.contains(name.substr(0, 3) + end); });
}

/// Names that differ by their last letter only, which is A, B, C and so on: without it.
std::set<std::string> SeriesOf(const std::set<std::string>& all) {
  std::set<std::string> series;
  for (const std::string& name : all) {
    if (name.size() < 3 || name.back() != 'a') continue;
    const std::string stem = name.substr(0, name.size() - 1);
    if (all.contains(stem + 'b') && all.contains(stem + 'c')) series.insert(stem);
  }
  return series;
}

bool IsOfSeries(const std::string& name, const std::set<std::string>& series) {
  constexpr char kLast = 'h';
  return !name.empty() && name.back() >= 'a' && name.back() <= kLast &&
         series.contains(name.substr(0, name.size() - 1));
}

/// The labels of a person on their way to one meaning each.
class LabelsOfPerson {
 public:
  LabelsOfPerson(const std::vector<std::string>& labels, const std::vector<bool>& seen,
                 const LandmarkTable& table, const std::vector<std::string>& prefix)
      : table_(table), read_(labels.size()), is_used_(labels.size(), true) {
    std::vector<LabelParser> parsers;
    std::set<std::string> all;
    for (const std::string& label : labels) {
      parsers.emplace_back(label, table, prefix);
      all.insert(parsers.back().whole());
    }
    const std::set<std::string> series = SeriesOf(all);
    for (std::size_t i = 0; i < labels.size(); ++i) {
      if (!seen.empty() && !seen[i]) is_used_[i] = false;
      if (IsCopy(labels[i])) {
        read_[i].why_left_out = "another point of the same name";
      } else if (parsers[i].is_computed() || IsOfAxes(parsers[i].whole(), all)) {
        read_[i].why_left_out = "a computed point";
      } else {
        const bool is_of_series = IsOfSeries(parsers[i].whole(), series);
        Take(is_of_series ? parsers[i].OfSeries() : parsers[i].Candidates(), parsers[i].whole(),
             all, &read_[i]);
        if (is_of_series && read_[i].readings.empty()) {
          read_[i].why_left_out = "one of a series of an unknown part of the body";
        }
      }
      if (read_[i].readings.empty()) is_used_[i] = false;
      bones_.push_back(parsers[i].Bones());
    }
  }

  int num_used() const {
    return static_cast<int>(std::count(is_used_.begin(), is_used_.end(), true));
  }

  std::vector<ReadLabel> Read() {
    TakeAloneWithoutSide();
    if (AreBones()) TakeBones();
    SortReadings(AreKeypoints());
    PreferShownLimbs();
    TakeFree();
    LeaveOutLoneLimbs();
    LeaveOutJointsOfMarkers();
    return std::move(read_);
  }

 private:
  /// Readings that the other labels allow. LARM is no left arm where nothing begins with R and most
  /// labels have no side.
  void Take(const std::vector<Candidate>& candidates, const std::string& whole,
            const std::set<std::string>& all, ReadLabel* label) {
    const bool is_lumbar =
        whole.size() == 2 && whole[0] == 'l' && whole[1] >= '0' && whole[1] <= '9';
    bool has_side = false, is_attached = false, is_pair = false;
    std::vector<LabelReading> without_side;
    std::vector<std::pair<std::size_t, LabelReading>> by_doubt;
    for (const Candidate& one : candidates) {
      const bool is_sided = Of(one.reading).is_sided;
      if (!is_sided && is_lumbar && all.contains("r" + whole.substr(1))) continue;
      const auto& others = one.counterparts;
      const bool has_other = std::any_of(others.begin(), others.end(),
                                         [&](const auto& other) { return all.contains(other); });
      if (one.needs_counterpart && !has_other) continue;
      if (is_sided && one.reading.side == BodySide::kNone) {
        without_side.push_back(one.reading);
        continue;
      }
      const bool is_part = !others.empty();
      constexpr std::size_t kNoPair = 100;
      const std::size_t doubt = !is_part ? 0 : has_other ? one.side_length : kNoPair;
      by_doubt.emplace_back(doubt, one.reading);
      has_side |= is_sided;
      is_attached |= is_part;
      is_pair |= has_other;
    }
    // LIEL, beside RIEL, is no left EL.
    std::stable_sort(by_doubt.begin(), by_doubt.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    for (const auto& [unused, reading] : by_doubt) label->readings.push_back(reading);
    if (!has_side && label->readings.empty()) {
      if (!without_side.empty()) ++num_without_side_;
      label->readings = std::move(without_side);
    } else if (is_attached && !is_pair && !without_side.empty()) {
      alone_.emplace_back(label, without_side);
    }
  }

  void TakeAloneWithoutSide() {
    if (num_without_side_ < kSeveral) return;
    for (auto& [label, readings] : alone_) label->readings = std::move(readings);
  }

  const Landmark& Of(const LabelReading& reading) const {
    return table_.landmarks()[static_cast<std::size_t>(reading.landmark)];
  }

  bool HasKind(const ReadLabel& label, LandmarkKind kind) const {
    return std::any_of(label.readings.begin(), label.readings.end(),
                       [&](const auto& reading) { return Of(reading).kind == kind; });
  }

  /// Names of a skeleton's bones, one point each, and none of what markers are put on.
  bool AreBones() const {
    constexpr int kFewest = 8;
    std::set<std::pair<int, BodySide>> sided;
    int bones = 0;
    for (std::size_t i = 0; i < read_.size(); ++i) {
      if (!is_used_[i]) continue;
      const LabelReading& marker = read_[i].readings[0];
      const Landmark& landmark = Of(marker);
      if (bones_[i].empty()) {
        const bool is_limb = LimbsOf(landmark.part) != Limbs::kNone && landmark.part != "foot";
        if (is_limb || (landmark.part == "pelvis" && landmark.is_sided)) return false;
      } else if (landmark.is_sided) {
        ++bones;
        sided.emplace(bones_[i][0].landmark, bones_[i][0].side);
      }
    }
    return bones >= kFewest && static_cast<int>(sided.size()) == bones;
  }

  void TakeBones() {
    for (std::size_t i = 0; i < read_.size(); ++i) {
      if (!bones_[i].empty() && is_used_[i]) read_[i].readings = bones_[i];
    }
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
      const std::string& part = Of(label.readings[0]).part;
      if (!may_be_keypoint && part != "head" && part != "foot" && part != "hand") return false;
    }
    return joints >= 4;
  }

  void SortReadings(bool are_keypoints) {
    for (ReadLabel& label : read_) {
      std::stable_sort(label.readings.begin(), label.readings.end(),
                       [&](const auto& a, const auto& b) {
                         const bool a_is_joint = Of(a).kind == LandmarkKind::kJoint;
                         const bool b_is_joint = Of(b).kind == LandmarkKind::kJoint;
                         return a_is_joint != b_is_joint && a_is_joint == are_keypoints;
                       });
    }
  }

  /// Arms or legs that no other label names are not there.
  void PreferShownLimbs() {
    const auto is_of = [&](const LabelReading& one, Limbs limbs) {
      return LimbsOf(Of(one).part) == limbs;
    };
    const auto count = [&](Limbs limbs) {
      int labels = 0;
      for (std::size_t i = 0; i < read_.size(); ++i) {
        const auto& readings = read_[i].readings;
        labels += is_used_[i] && std::all_of(readings.begin(), readings.end(),
                                             [&](const auto& one) { return is_of(one, limbs); });
      }
      return labels;
    };
    const int arms = count(Limbs::kArms), legs = count(Limbs::kLegs);
    if (arms + legs > 0) TellHandsFromFeet(legs > 0 ? "hand" : "foot");
    if ((arms == 0) == (legs == 0)) return;
    const Limbs absent = arms == 0 ? Limbs::kArms : Limbs::kLegs;
    for (ReadLabel& label : read_) {
      std::stable_partition(label.readings.begin(), label.readings.end(),
                            [&](const auto& one) { return !is_of(one, absent); });
    }
  }

  /// MET2 is of the foot where legs are there, else of the hand. absent: "hand" or "foot".
  void TellHandsFromFeet(const std::string& absent) {
    for (ReadLabel& label : read_) {
      const auto is_of = [&](const std::string& part) {
        return std::any_of(label.readings.begin(), label.readings.end(),
                           [&](const auto& one) { return Of(one).part == part; });
      };
      if (!is_of("hand") || !is_of("foot")) continue;
      std::erase_if(label.readings, [&](const auto& one) { return Of(one).part == absent; });
    }
  }

  /// A leg that one or two labels name and nothing else of the body bears out, no pelvis and not
  /// the other leg, is none: RTB, beside the labels of an arm, is of that. The same of arms.
  void LeaveOutLoneLimbs() {
    constexpr int kFewestOfLimb = 3;
    for (const auto& [limbs, root, name] : {std::tuple(Limbs::kArms, "shoulder", "an arm"),
                                            std::tuple(Limbs::kLegs, "pelvis", "a leg")}) {
      std::vector<ReadLabel*> labels;
      bool is_rooted = false, are_clusters = true;
      int others = 0;
      std::map<BodySide, int> count;
      for (std::size_t i = 0; i < read_.size(); ++i) {
        if (!is_used_[i] || !read_[i].why_left_out.empty()) continue;
        const LabelReading& one = read_[i].readings[0];
        const Landmark& landmark = Of(one);
        if (LimbsOf(landmark.part) == limbs) {
          labels.push_back(&read_[i]);
          ++count[one.side];
          are_clusters &= landmark.kind == LandmarkKind::kSegment;
        } else {
          is_rooted |= landmark.part == root;
          ++others;
        }
      }
      const bool is_of_one_side = count.size() < 2;
      const bool are_few = std::all_of(count.begin(), count.end(), [&](const auto& side) {
        return side.second < kFewestOfLimb;
      });
      const bool is_borne_out =
          are_clusters ? is_rooted && !is_of_one_side : is_rooted || !is_of_one_side;
      if (!are_few || is_borne_out || others < kFewestOfLimb) continue;
      for (ReadLabel* label : labels) {
        label->why_left_out = std::string("nothing else shows ") + name;
      }
    }
  }

  /// Takes the first of several readings that no label without choice has.
  void TakeFree() {
    std::set<std::pair<int, BodySide>> taken;
    const auto key = [](const LabelReading& one) { return std::pair(one.landmark, one.side); };
    for (std::size_t i = 0; i < read_.size(); ++i) {
      if (is_used_[i] && read_[i].readings.size() == 1) taken.insert(key(read_[i].readings[0]));
    }
    // LELB is at the elbow in any case, LLE may be at the knee.
    for (const bool of_one_part : {true, false}) {
      for (std::size_t i = 0; i < read_.size(); ++i) {
        auto& readings = read_[i].readings;
        if (!is_used_[i] || readings.size() < 2) continue;
        const bool is_of_one = std::all_of(readings.begin(), readings.end(), [&](const auto& one) {
          return Of(one).part == Of(readings[0]).part;
        });
        if (is_of_one != of_one_part) continue;
        const auto free =
            std::stable_partition(readings.begin(), readings.end(), [&](const auto& one) {
              return Of(one).kind == LandmarkKind::kSegment || !taken.contains(key(one));
            });
        if (free != readings.begin()) taken.insert(key(readings[0]));
      }
    }
  }

  /// A joint's centre tells nothing beside markers on both of its sides, of which it was computed.
  void LeaveOutJointsOfMarkers() {
    const auto count = [&](const std::string& part, BodySide side) {
      int markers = 0;
      for (std::size_t i = 0; i < read_.size(); ++i) {
        if (!is_used_[i] || !read_[i].why_left_out.empty()) continue;
        const LabelReading& one = read_[i].readings[0];
        const Landmark& landmark = Of(one);
        const bool is_there = landmark.part == part && landmark.kind == LandmarkKind::kSkin &&
                              (part == "pelvis" || one.side == side);
        markers += is_there ? 1 : 0;
      }
      return markers;
    };
    for (std::size_t i = 0; i < read_.size(); ++i) {
      if (!is_used_[i] || Of(read_[i].readings[0]).kind != LandmarkKind::kJoint) continue;
      const LabelReading& one = read_[i].readings[0];
      const std::string& part = Of(one).part;
      if (part == "head" || part == "neck" || part == "thorax") continue;
      if (count(part, one.side) >= (part == "pelvis" ? 3 : 1)) {
        read_[i].why_left_out = "a joint's centre beside its markers";
      }
    }
  }

  const LandmarkTable& table_;
  std::vector<ReadLabel> read_;
  std::vector<bool> is_used_;
  std::vector<std::vector<LabelReading>> bones_;  ///< what labels mean as names of bones
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
  LabelsOfPerson person(labels, seen, table, {});
  const std::vector<std::string> prefix = CommonPrefix(labels);
  if (prefix.empty()) return person.Read();
  LabelsOfPerson shortened(labels, seen, table, prefix);
  return shortened.num_used() > person.num_used() ? shortened.Read() : person.Read();
}

}  // namespace mmm_converter
