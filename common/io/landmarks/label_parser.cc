// SPDX-License-Identifier: MIT
#include "common/io/landmarks/label_parser.h"

#include <algorithm>
#include <map>
#include <utility>

namespace mmm_converter {
namespace {

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

}  // namespace

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

}  // namespace mmm_converter
