// SPDX-License-Identifier: MIT
#include "common/io/c3d/c3d_parameters.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <tuple>
#include <utility>

#include "common/support/text.h"

namespace mmm_converter {
namespace {

using Bytes = std::span<const unsigned char>;

// Each costs far more than its bytes. Files have some hundreds; names for all points that there can
// be take 257.
constexpr std::size_t kMostParameters = 10000;

int SignedByte(unsigned char byte) { return static_cast<std::int8_t>(byte); }

std::string UpperName(Bytes bytes) {
  std::string name(Trim({reinterpret_cast<const char*>(bytes.data()), bytes.size()}));
  std::transform(name.begin(), name.end(), name.begin(), [](char c) {
    return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  });
  return name;
}

/// The fixed part of a group or parameter record.
struct Record {
  std::size_t begin = 0;
  int id = 0;  // negative: group
  std::string name;
  std::size_t offset_at = 0;  // of the word that gives the way to the next record
  std::uint16_t offset = 0;
};

/// Nothing where no record can start at this byte (or the list of records ends here).
std::optional<Record> ReadRecord(Bytes section, std::size_t at, C3dProcessor processor) {
  if (at + 2 > section.size()) return std::nullopt;
  const std::size_t length = std::abs(SignedByte(section[at]));
  Record record;
  record.begin = at;
  record.id = SignedByte(section[at + 1]);
  record.offset_at = at + 2 + length;
  if (length == 0 || length > 127 || record.id == 0) return std::nullopt;
  if (record.offset_at + 2 > section.size()) return std::nullopt;
  const Bytes name = section.subspan(at + 2, length);
  if (std::any_of(name.begin(), name.end(), [](unsigned char c) { return c != 0 && c < 0x20; })) {
    return std::nullopt;
  }
  record.name = UpperName(name);
  record.offset = C3dWord(&section[record.offset_at], processor);
  return record;
}

/// The list of records ends at this byte.
bool IsEnd(Bytes section, std::size_t at) {
  return at == section.size() ||
         (at < section.size() &&
          (section[at] == 0 || (at + 1 < section.size() && section[at + 1] == 0)));
}

/// The record's offset leads to another record, or says that there is none.
bool LeadsOn(Bytes section, const Record& record, C3dProcessor processor) {
  const std::size_t next = record.offset_at + record.offset;
  return record.offset == 0 || IsEnd(section, next) || ReadRecord(section, next, processor);
}

struct Step {
  std::size_t at = 0;
  std::optional<Record> record;  // nothing: the list ends
};

/// Where a record's offset leads to, or else where its size ends: neither can be trusted alone.
Step NextRecord(Bytes section, const Record& record, std::size_t by_size, C3dProcessor processor,
                Warnings* warnings) {
  if (record.offset == 0) return {by_size, std::nullopt};
  const std::size_t by_offset = record.offset_at + record.offset;
  const bool forward = record.offset >= 2 && by_offset <= section.size();
  const bool into_itself = by_offset < by_size;  // or its size is wrong
  if (forward) {
    Step step{by_offset, ReadRecord(section, by_offset, processor)};
    if (step.record && (!into_itself || LeadsOn(section, *step.record, processor))) return step;
    if (!step.record && !into_itself && IsEnd(section, by_offset)) return step;
  }
  if (auto next = ReadRecord(section, by_size, processor)) {
    WarnOfKind(warnings, "parameters whose offset to the next one is wrong",
               fmt::format("parameter {}: the offset {} to the next one is wrong", record.name,
                           static_cast<std::int16_t>(record.offset)));
    return {by_size, std::move(next)};
  }
  if (forward && IsEnd(section, by_offset)) return {by_offset, std::nullopt};
  Warn(warnings, fmt::format("parameters behind {} can't be read", record.name));
  return {by_size, std::nullopt};
}

/// Type, dimensions and data of a parameter; `size_end` becomes the byte behind its description.
std::optional<C3dParameter> ReadParameter(Bytes section, const Record& record,
                                          C3dProcessor processor, std::size_t* size_end) {
  std::size_t at = record.offset_at + 2;
  *size_end = section.size();
  if (at + 2 > section.size()) return std::nullopt;
  C3dParameter parameter;
  parameter.name = record.name;
  parameter.processor = processor;
  parameter.type = SignedByte(section[at]);
  const std::size_t num_dimensions = section[at + 1];
  at += 2;
  const bool known_type =
      parameter.type == -1 || parameter.type == 1 || parameter.type == 2 || parameter.type == 4;
  if (!known_type || num_dimensions > 7 || at + num_dimensions > section.size()) {
    return std::nullopt;
  }
  std::uint64_t bytes = std::abs(parameter.type);  // at most 4 * 255^7 < 2^58
  for (std::size_t i = 0; i < num_dimensions; ++i) {
    parameter.dimensions.push_back(section[at + i]);
    bytes *= section[at + i];
  }
  at += num_dimensions;
  const std::size_t there =
      static_cast<std::size_t>(std::min<std::uint64_t>(bytes, section.size() - at));
  parameter.data = section.subspan(at, there);
  at += there;
  if (at < section.size()) *size_end = std::min(at + 1 + section[at], section.size());
  return parameter;
}

}  // namespace

std::size_t C3dParameter::size() const {
  return type == -1 ? 0 : data.size() / static_cast<std::size_t>(std::abs(type));
}

std::optional<double> C3dParameter::Number(std::size_t index) const {
  if (index >= size()) return std::nullopt;
  if (type == 1) return data[index];
  if (type == 2) return C3dWord(&data[2 * index], processor);
  return C3dFloat(&data[4 * index], processor);
}

std::size_t C3dParameter::num_texts() const {
  if (type != -1 || data.empty()) return 0;
  const std::size_t width = dimensions.empty() ? 1 : dimensions[0];
  return (data.size() + width - 1) / width;
}

std::vector<std::string> C3dParameter::Texts(std::size_t most) const {
  std::vector<std::string> texts;
  const std::size_t width = dimensions.empty() ? 1 : dimensions[0];
  const std::size_t count = std::min(most, num_texts());
  for (std::size_t at = 0; at < count * width; at += width) {
    const Bytes text = data.subspan(at, std::min(width, data.size() - at));
    texts.emplace_back(Trim({reinterpret_cast<const char*>(text.data()), text.size()}));
  }
  return texts;
}

std::string C3dParameter::Text() const {
  const std::vector<std::string> texts = Texts(1);
  return texts.empty() ? std::string() : texts.front();
}

C3dParameters::C3dParameters(Bytes section, C3dProcessor processor, Warnings* warnings) {
  std::map<int, std::string> groups;
  std::vector<int> group_ids;
  end_ = 4;  // the section's own header
  for (std::optional<Record> record = ReadRecord(section, end_, processor); record;) {
    const std::size_t content = record->offset_at + 2;
    std::size_t by_size = section.size();
    if (content < section.size()) by_size = std::min(content + 1 + section[content], by_size);
    std::optional<C3dParameter> parameter;
    if (record->id > 0 && parameters_.size() == kMostParameters) {
      Warn(warnings,
           fmt::format("more than {} parameters; the others are left out", kMostParameters));
      break;
    }
    if (record->id > 0) parameter = ReadParameter(section, *record, processor, &by_size);
    Step next = NextRecord(section, *record, by_size, processor, warnings);
    end_ = next.at;

    if (record->id < 0) {
      if (groups.emplace(-record->id, record->name).second) groups_.push_back(record->name);
    } else if (parameter) {
      const std::size_t begin = parameter->data.data() - section.data();
      const std::size_t room = end_ > begin ? end_ - begin : 0;
      parameter->data = parameter->data.first(std::min(parameter->data.size(), room));
      parameter->begin = static_cast<std::uint32_t>(record->begin);
      parameter->end = static_cast<std::uint32_t>(end_);
      group_ids.push_back(record->id);
      parameters_.push_back(std::move(*parameter));
    } else {
      WarnOfKind(warnings, "parameters that can't be read",
                 fmt::format("parameter {} can't be read", record->name));
    }
    record = std::move(next.record);
  }
  for (std::size_t i = 0; i < parameters_.size(); ++i) {
    const auto group = groups.find(group_ids[i]);
    if (group != groups.end()) parameters_[i].group = group->second;
    const auto& [group_name, name] = std::tie(parameters_[i].group, parameters_[i].name);
    if (!places_.emplace(std::pair(group_name, name), i).second) {
      WarnOfKind(
          warnings, "parameters that are there twice",
          fmt::format("parameter {}:{} is there twice; the first is used", group_name, name));
    }
  }
}

const C3dParameter* C3dParameters::Find(std::string_view group, std::string_view name) const {
  const auto place = places_.find({std::string(group), std::string(name)});
  return place == places_.end() ? nullptr : &parameters_[place->second];
}

std::optional<double> C3dParameters::Number(std::string_view group, std::string_view name) const {
  const C3dParameter* parameter = Find(group, name);
  return parameter == nullptr ? std::nullopt : parameter->Number(0);
}

std::string C3dParameters::Text(std::string_view group, std::string_view name) const {
  const C3dParameter* parameter = Find(group, name);
  return parameter == nullptr ? std::string() : parameter->Text();
}

std::vector<std::string> C3dParameters::TextList(std::string_view group, const std::string& name,
                                                 std::size_t most, std::size_t* there) const {
  std::vector<std::string> all;
  if (there != nullptr) *there = 0;
  for (int i = 1;; ++i) {
    const C3dParameter* parameter = Find(group, i == 1 ? name : fmt::format("{}{}", name, i));
    if (parameter == nullptr) return all;
    for (std::string& text : parameter->Texts(most - all.size())) all.push_back(std::move(text));
    if (there != nullptr) *there += parameter->num_texts();
  }
}

}  // namespace mmm_converter
