// SPDX-License-Identifier: MIT
#include "common/io/c3d/c3d_section_edit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <set>
#include <string_view>
#include <utility>

#include "common/support/error.h"

namespace mmm_converter {
namespace {

constexpr std::size_t kMostTexts = 255;     // that a dimension can count
constexpr std::size_t kLargestWay = 32767;  // from a record to the next that every reader can go
constexpr std::size_t kMostBlocks = 255;
constexpr std::size_t kSectionHeader = 4;

using Texts = std::vector<std::string>;

std::vector<const C3dParameter*> Chain(const C3dParameters& parameters, const std::string& name) {
  std::vector<const C3dParameter*> chain;
  for (int i = 1;; ++i) {
    const C3dParameter* one =
        parameters.Find("POINT", i == 1 ? name : fmt::format("{}{}", name, i));
    if (one == nullptr) return chain;
    chain.push_back(one);
  }
}

std::size_t WidthOf(const C3dParameter& texts) {
  return texts.dimensions.empty() ? 1 : static_cast<std::size_t>(texts.dimensions[0]);
}

std::size_t LengthOf(const std::string& text) {
  const std::size_t last = text.find_last_not_of(std::string_view(" \0", 2));
  return last == std::string::npos ? 0 : last + 1;
}

/// A record of texts, taken apart.
struct TextRecord {
  std::string head;       // length of the name, group and name
  bool is_last = false;   // by its offset
  std::size_t width = 1;  // of a text
  Texts texts;
  std::string description = std::string(1, '\0');  // with its length
  std::string rest = {};                           // up to the next record

  /// Texts of this width that fit.
  std::size_t Capacity() const {
    const std::size_t others = 2 + 4 + description.size() + rest.size();
    const std::size_t room = kLargestWay - std::min(others, kLargestWay);
    return std::min(kMostTexts, room / std::max<std::size_t>(width, 1));
  }
};

TextRecord TakeApart(const std::vector<unsigned char>& section, const C3dParameter& parameter) {
  const auto bytes = [&](std::size_t begin, std::size_t end) {
    return std::string(section.begin() + static_cast<std::ptrdiff_t>(begin),
                       section.begin() + static_cast<std::ptrdiff_t>(end));
  };
  TextRecord record;
  const std::size_t name = parameter.begin + 2;
  const std::size_t offset_at =
      name + static_cast<std::size_t>(std::abs(static_cast<std::int8_t>(section[parameter.begin])));
  record.head = bytes(parameter.begin, offset_at);
  record.is_last = section[offset_at] == 0 && section[offset_at + 1] == 0;
  record.width = WidthOf(parameter);
  std::size_t at = offset_at + 4 + parameter.dimensions.size() + parameter.data.size();
  std::size_t stated = 1;
  for (const int size : parameter.dimensions) stated *= static_cast<std::size_t>(size);
  if (parameter.data.size() < stated || at >= parameter.end) return record;  // it is cut
  const std::size_t described = at + 1 + section[at];
  if (described > parameter.end) return record;
  record.description = bytes(at, described);
  record.rest = bytes(described, parameter.end);
  return record;
}

std::string Assemble(const TextRecord& record, C3dProcessor processor) {
  std::string content;
  content += static_cast<char>(-1);
  content += static_cast<char>(2);
  content += static_cast<char>(record.width);
  content += static_cast<char>(record.texts.size());
  for (const std::string& text : record.texts) {
    content += text.substr(0, record.width);
    if (text.size() < record.width) content.append(record.width - text.size(), ' ');
  }
  content += record.description + record.rest;
  unsigned char offset[2] = {0, 0};
  if (!record.is_last) StoreC3dWord(static_cast<int>(content.size() + 2), processor, offset);
  return record.head + std::string(offset, offset + 2) + content;
}

/// Distributes texts over the records as they have them now; more follow in the last and in new
/// records.
void Distribute(const Texts& texts, const std::string& name, int group,
                const std::vector<std::size_t>& counts, std::vector<TextRecord>* records) {
  std::size_t done = 0;
  const auto fill = [&](TextRecord* record, std::size_t most) {
    std::size_t end = done + std::min(most, texts.size() - done);
    for (std::size_t i = done; i < end; ++i) {
      record->width = std::max(record->width, LengthOf(texts[i]));
    }
    end = std::min(end, done + record->Capacity());
    record->texts.assign(texts.begin() + static_cast<std::ptrdiff_t>(done),
                         texts.begin() + static_cast<std::ptrdiff_t>(end));
    done = end;
  };
  for (std::size_t k = 0; k < counts.size(); ++k) {
    fill(&(*records)[k], k + 1 < counts.size() ? counts[k] : kMostTexts);
  }
  while (done < texts.size()) {
    TextRecord next;
    const std::string own =
        records->empty() ? name : fmt::format("{}{}", name, records->size() + 1);
    next.head = std::string(1, static_cast<char>(own.size())) + static_cast<char>(group) + own;
    if (!records->empty()) next.is_last = std::exchange(records->back().is_last, false);
    fill(&next, kMostTexts);
    records->push_back(std::move(next));
  }
}

std::string NumberRecord(const std::string& name, int group, int type,
                         const std::vector<int>& sizes, const std::string& data,
                         C3dProcessor processor) {
  std::string content{static_cast<char>(type), static_cast<char>(sizes.size())};
  for (const int size : sizes) content += static_cast<char>(size);
  content += data + '\0';
  unsigned char offset[2];
  StoreC3dWord(static_cast<int>(content.size() + 2), processor, offset);
  return std::string{static_cast<char>(name.size()), static_cast<char>(group)} + name +
         std::string(offset, offset + 2) + content;
}

// What each event has; other parameters of the group stay.
constexpr const char* kOfEvents[] = {"USED",     "TIMES",        "LABELS",   "CONTEXTS",
                                     "SUBJECTS", "DESCRIPTIONS", "ICON_IDS", "GENERIC_FLAGS"};

bool IsOfEvents(std::string name) {
  while (!name.empty() && name.back() >= '0' && name.back() <= '9') name.pop_back();
  return std::find(std::begin(kOfEvents), std::end(kOfEvents), name) != std::end(kOfEvents);
}

std::string EventRecords(const std::vector<C3dEvent>& events, int group, C3dProcessor processor) {
  constexpr int kStrike = 1, kOff = 2;  // ICON_IDS of Vicon's
  constexpr double kSecondsPerMinute = 60;
  const int count = static_cast<int>(events.size());
  unsigned char word[2];
  unsigned char number[4];
  std::string used, times, icons;
  const std::string flags(events.size(), '\0');
  StoreC3dWord(count, processor, word);
  used.append(word, word + 2);
  for (const C3dEvent& event : events) {
    const double minutes = std::floor(event.time / kSecondsPerMinute);
    for (const double part : {minutes, event.time - kSecondsPerMinute * minutes}) {
      StoreC3dFloat(static_cast<float>(part), processor, number);
      times.append(number, number + 4);
    }
    const bool is_foot_off = event.label == "Foot Off";
    StoreC3dWord(event.label == "Foot Strike" ? kStrike : (is_foot_off ? kOff : 0), processor,
                 word);
    icons.append(word, word + 2);
  }
  const auto texts = [&](const char* name, std::string C3dEvent::*of) {
    TextRecord record;
    record.head =
        std::string{static_cast<char>(std::strlen(name)), static_cast<char>(group)} + name;
    for (const C3dEvent& event : events) {
      record.texts.push_back(event.*of);
      record.width = std::max(record.width, std::min(kMostTexts, (event.*of).size()));
    }
    return Assemble(record, processor);
  };
  return NumberRecord("USED", group, 2, {}, used, processor) + texts("LABELS", &C3dEvent::label) +
         texts("CONTEXTS", &C3dEvent::context) + texts("SUBJECTS", &C3dEvent::subject) +
         NumberRecord("ICON_IDS", group, 2, {count}, icons, processor) +
         NumberRecord("GENERIC_FLAGS", group, 1, {count}, flags, processor) +
         NumberRecord("TIMES", group, 4, {2, count}, times, processor);
}

}  // namespace

C3dSectionEdit::C3dSectionEdit(std::vector<unsigned char> section, const C3dParameters& parameters,
                               std::string file)
    : section_(std::move(section)), parameters_(parameters), file_(std::move(file)) {}

void C3dSectionEdit::SetNumber(const C3dParameter& parameter, int number) {
  if (parameter.size() == 0) return;
  unsigned char* const p = &section_[parameter.begin];
  const std::size_t name = static_cast<std::size_t>(std::abs(static_cast<std::int8_t>(p[0])));
  unsigned char* const data = p + 2 + name + 4 + parameter.dimensions.size();
  if (parameter.type == 2) {
    StoreC3dWord(number, parameter.processor, data);
  } else if (parameter.type == 4) {
    StoreC3dFloat(static_cast<float>(number), parameter.processor, data);
  } else if (number <= 255) {
    *data = static_cast<unsigned char>(number);
  } else {
    throw Error(fmt::format("{}: {}:{} is a byte, which can't be {}", file_, parameter.group,
                            parameter.name, number));
  }
}

std::vector<std::string> C3dSectionEdit::StoredTexts(const C3dParameters& parameters,
                                                     const std::string& name) {
  Texts texts;
  for (const C3dParameter* one : Chain(parameters, name)) {
    const std::size_t width = WidthOf(*one);
    const auto* const data = reinterpret_cast<const char*>(one->data.data());
    for (std::size_t i = 0; i < one->num_texts(); ++i) {
      texts.emplace_back(data + i * width, std::min(width, one->data.size() - i * width));
    }
  }
  return texts;
}

void C3dSectionEdit::SetPointTexts(const std::string& name, const Texts& texts) {
  if (StoredTexts(parameters_, name) == texts) return;
  const std::vector<const C3dParameter*> chain = Chain(parameters_, name);
  const C3dParameter* const before = chain.empty() ? FindOfPoints() : chain.back();
  std::vector<TextRecord> records;
  std::vector<std::size_t> counts;
  for (const C3dParameter* one : chain) {
    records.push_back(TakeApart(section_, *one));
    counts.push_back(one->num_texts());
  }
  const int group = before != nullptr ? section_[before->begin + 1] : GroupOf("POINT");
  Distribute(texts, name, group, counts, &records);
  std::string more;
  for (std::size_t k = 0; k < records.size(); ++k) {
    const std::string bytes = Assemble(records[k], processor());
    if (k < chain.size()) {
      edits_.push_back({chain[k]->begin, chain[k]->end, bytes});
    } else {
      more += bytes;
    }
  }
  const std::size_t at = before != nullptr ? before->end : kSectionHeader;
  edits_.push_back({at, at, more});
}

C3dProcessor C3dSectionEdit::processor() const {
  const int byte = section_[3];
  return static_cast<C3dProcessor>(byte <= 3 ? byte + 83 : byte);
}

const C3dParameter* C3dSectionEdit::FindOfPoints() const {
  for (const C3dParameter& one : parameters_.all()) {
    if (one.group == "POINT" && !TakeApart(section_, one).is_last) return &one;
  }
  return nullptr;
}

int C3dSectionEdit::GroupOf(const std::string& name) {
  constexpr int kMostGroups = 127;
  std::set<int> used;
  for (const C3dParameter& one : parameters_.all()) {
    const int group = section_[one.begin + 1];
    if (one.group == name) return group;
    used.insert(group);
  }
  if (const auto begun = new_groups_.find(name); begun != new_groups_.end()) return begun->second;
  for (const auto& [other, number] : new_groups_) used.insert(number);
  int group = kMostGroups;
  while (used.contains(group)) --group;
  new_groups_[name] = group;
  std::string record{static_cast<char>(name.size()), static_cast<char>(-group)};
  record += name;
  unsigned char offset[2];
  StoreC3dWord(3, processor(), offset);  // two bytes of itself and an empty description
  record.append(offset, offset + 2);
  record += '\0';
  edits_.push_back({kSectionHeader, kSectionHeader, record});
  return group;
}

void C3dSectionEdit::SetEvents(const std::vector<C3dEvent>& events) {
  if (events.size() > kMostTexts) {
    throw Error(fmt::format("{}: {} events; a C3D file holds at most {}", file_, events.size(),
                            kMostTexts));
  }
  const int group = GroupOf("EVENT");
  std::size_t at = kSectionHeader;
  for (const C3dParameter& one : parameters_.all()) {
    if (one.group != "EVENT" || !IsOfEvents(one.name)) continue;
    if (at == kSectionHeader) at = one.begin;
    edits_.push_back({one.begin, one.end, ""});
  }
  edits_.push_back({at, at, EventRecords(events, group, processor())});
}

// Room for records; what stands behind the zeros stays where it is.
std::size_t C3dSectionEdit::ZerosBehindRecords() const {
  const std::size_t begin = parameters_.end();
  const std::size_t end =
      std::min(section_.size(),
               std::max<std::size_t>(section_[2] * kBlock, (begin + kBlock - 1) / kBlock * kBlock));
  std::size_t at = begin;
  while (at < end && section_[at] == 0) ++at;
  return at - begin;
}

void C3dSectionEdit::StateSize() {
  section_[2] = static_cast<unsigned char>(std::min(kMostBlocks, section_.size() / kBlock));
}

std::size_t C3dSectionEdit::MoreBlocks() const {
  constexpr std::size_t kEnd = 2;  // zeros that end the records
  std::size_t before = 0;
  std::size_t after = 0;
  for (const Edit& edit : edits_) {
    before += edit.end - edit.begin;
    after += edit.bytes.size();
  }
  if (after <= before || after - before + kEnd <= ZerosBehindRecords()) return 0;
  const std::size_t more = (after - before + kEnd + kBlock - 1) / kBlock;
  if (section_[2] + more <= kMostBlocks) return more;
  throw Error(
      fmt::format("{}: with these labels and events the parameters need {} blocks; at most {} fit",
                  file_, section_[2] + more, kMostBlocks));
}

std::vector<unsigned char> C3dSectionEdit::Finish() const {
  std::vector<Edit> edits = edits_;
  std::stable_sort(edits.begin(), edits.end(), [](const Edit& a, const Edit& b) {
    return std::pair(a.begin, a.end) < std::pair(b.begin, b.end);
  });
  std::vector<unsigned char> out;
  std::size_t done = 0;
  const auto keep_until = [&](std::size_t end) {
    out.insert(out.end(), section_.begin() + static_cast<std::ptrdiff_t>(done),
               section_.begin() + static_cast<std::ptrdiff_t>(end));
    done = end;
  };
  for (const Edit& edit : edits) {
    keep_until(edit.begin);
    out.insert(out.end(), edit.bytes.begin(), edit.bytes.end());
    done = edit.end;
  }
  keep_until(parameters_.end());
  const std::size_t more = MoreBlocks();
  out[2] = static_cast<unsigned char>(section_[2] + more);
  const std::size_t shifted_end = done + more * kBlock;
  if (out.size() < shifted_end) out.resize(shifted_end, 0);
  done += out.size() - shifted_end;  // zeros that are records now
  keep_until(section_.size());
  return out;
}

}  // namespace mmm_converter
