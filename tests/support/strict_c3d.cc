// SPDX-License-Identifier: MIT
#include "tests/support/strict_c3d.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

namespace mmm_converter::testing {
namespace {

[[noreturn]] void Refuse(const std::string& what) { throw std::runtime_error("C3D: " + what); }

class C3dBits {
 public:
  C3dBits(std::string_view bytes, int processor) : bytes_(bytes), processor_(processor) {}

  int Byte(std::size_t at) const {
    if (at >= bytes_.size()) Refuse("ends too early");
    return static_cast<unsigned char>(bytes_[at]);
  }
  int Word(std::size_t at) const {
    return processor_ == 86 ? 256 * Byte(at) + Byte(at + 1) : Byte(at) + 256 * Byte(at + 1);
  }
  double Real(std::size_t at) const {
    // Sign, exponent and mantissa by hand, as every processor has them.
    const long high = processor_ == 84 ? Word(at + 2) : Word(at);
    const long low = processor_ == 84 ? Word(at) : Word(at + 2);
    const long exponent = high >> 7 & 0xFF;
    if (exponent == 0) return 0;
    const double mantissa = 1 + static_cast<double>((high & 0x7F) * 65536 + low) / 8388608;
    const double value =
        std::ldexp(mantissa, static_cast<int>(exponent) - (processor_ == 85 ? 129 : 127));
    return (high & 0x8000) != 0 ? -value : value;
  }
  std::string Part(std::size_t at, std::size_t count) const {
    if (at + count > bytes_.size()) Refuse("ends too early");
    return std::string(bytes_.substr(at, count));
  }

 private:
  std::string_view bytes_;
  int processor_;
};

std::string WithoutPadding(std::string text) {
  while (!text.empty() && (text.back() == ' ' || text.back() == '\0')) text.pop_back();
  return text;
}

// content: of a parameter's record, from its type on.
std::vector<std::string> StrictTexts(const std::string& content) {
  if (content.at(0) != -1 || content.at(1) != 2) Refuse("a list of labels is not one of texts");
  const std::size_t width = static_cast<unsigned char>(content.at(2));
  const std::size_t count = static_cast<unsigned char>(content.at(3));
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < count; ++i) {
    texts.push_back(WithoutPadding(content.substr(4 + i * width, width)));
  }
  return texts;
}

std::vector<std::string> TextsOfAll(const StrictC3d& c3d, const std::string& name) {
  std::vector<std::string> all;
  for (int i = 1;; ++i) {
    const auto one = c3d.records.find("POINT:" + name + (i == 1 ? "" : std::to_string(i)));
    if (one == c3d.records.end()) return all;
    const std::vector<std::string> texts = StrictTexts(one->second);
    all.insert(all.end(), texts.begin(), texts.end());
  }
}

int Signed(int byte) { return byte < 128 ? byte : byte - 256; }

void ReadRecords(const C3dBits& bits, std::size_t section, std::size_t end, StrictC3d* c3d) {
  std::map<int, std::string> groups;
  std::vector<std::pair<int, std::string>> parameters;
  std::vector<std::string> contents;
  for (std::size_t at = section + 4; at + 2 < end;) {
    const int length = std::abs(Signed(bits.Byte(at)));
    const int id = Signed(bits.Byte(at + 1));
    if (length == 0 || id == 0) break;
    const std::string name = bits.Part(at + 2, static_cast<std::size_t>(length));
    const std::size_t offset_at = at + 2 + static_cast<std::size_t>(length);
    const int offset = bits.Word(offset_at);
    // The last record may say 0; it is as long as it is.
    std::size_t size = 0;
    std::size_t data = 1;
    if (id > 0) {
      const int num_dimensions = bits.Byte(offset_at + 3);
      data = static_cast<std::size_t>(std::abs(Signed(bits.Byte(offset_at + 2))));
      for (int i = 0; i < num_dimensions; ++i) {
        data *= static_cast<std::size_t>(bits.Byte(offset_at + 4 + static_cast<std::size_t>(i)));
      }
      data += 2 + static_cast<std::size_t>(num_dimensions);
      size = data + 1 + static_cast<std::size_t>(bits.Byte(offset_at + 2 + data));
    } else {
      size = 1 + static_cast<std::size_t>(bits.Byte(offset_at + 2));
    }
    if (offset != 0 && static_cast<std::size_t>(offset) != size + 2) {
      Refuse("record " + name + " has another size than its offset says");
    }
    if (offset_at + 2 + size > end) Refuse("record " + name + " is cut");
    contents.push_back(bits.Part(offset_at + 2, size));
    parameters.emplace_back(id, name);
    if (id < 0) groups[-id] = name;
    if (offset == 0) break;
    at = offset_at + static_cast<std::size_t>(offset);
  }
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const auto& [id, name] = parameters[i];
    c3d->order.push_back(id < 0 ? name : groups[id] + ":" + name);
    if (!c3d->records.emplace(c3d->order.back(), contents[i]).second) {
      Refuse(c3d->order.back() + " is there twice");
    }
  }
}

int NumberOf(const StrictC3d& c3d, const std::string& name, int processor) {
  const auto record = c3d.records.find(name);
  if (record == c3d.records.end()) Refuse("no " + name);
  const C3dBits bits(record->second, processor);
  const std::size_t at = 2 + static_cast<std::size_t>(bits.Byte(1));
  return record->second[0] == 4 ? static_cast<int>(bits.Real(at)) : bits.Word(at);
}

}  // namespace

int StrictC3d::Find(const std::string& label) const {
  const auto found = std::find(labels.begin(), labels.end(), label);
  return found == labels.end() ? -1 : static_cast<int>(found - labels.begin());
}

StrictC3d ReadStrictC3d(std::string_view file) {
  if (file.size() < 1024 || file[1] != 0x50) Refuse("no header");
  const std::size_t section = 512 * (static_cast<std::size_t>(file[0]) - 1);
  const int processor = static_cast<unsigned char>(file.at(section + 3));
  const C3dBits bits(file, processor);
  const auto header_word = [&](std::size_t number) { return bits.Word(2 * (number - 1)); };
  StrictC3d c3d;
  c3d.header = bits.Part(0, 512);
  c3d.points = header_word(2);
  c3d.data_block = header_word(9);
  const std::size_t data = 512 * (static_cast<std::size_t>(c3d.data_block) - 1);
  if (section + 512 * static_cast<std::size_t>(bits.Byte(section + 2)) > data) {
    Refuse("parameters reach into the data");
  }
  ReadRecords(bits, section, data, &c3d);
  if (c3d.records.contains("ANALOG:USED") &&
      NumberOf(c3d, "ANALOG:USED", processor) * header_word(10) != header_word(3)) {
    Refuse("ANALOG:USED and the header count other analog samples");
  }
  if (NumberOf(c3d, "POINT:USED", processor) != c3d.points)
    Refuse("POINT:USED is not the header's");
  if (NumberOf(c3d, "POINT:DATA_START", processor) != c3d.data_block) {
    Refuse("POINT:DATA_START is not the header's");
  }
  c3d.labels = TextsOfAll(c3d, "LABELS");
  c3d.descriptions = TextsOfAll(c3d, "DESCRIPTIONS");
  c3d.frames = header_word(5) - header_word(4) + 1;
  const std::size_t number_bytes = bits.Real(2 * (7 - 1)) < 0 ? 4 : 2;
  const std::size_t analog_bytes = number_bytes * static_cast<std::size_t>(header_word(3));
  std::size_t at = data;
  for (int k = 0; k < c3d.frames; ++k) {
    std::vector<std::string>& words = c3d.words.emplace_back();
    for (int i = 0; i < c3d.points; ++i, at += 4 * number_bytes) {
      words.push_back(bits.Part(at, 4 * number_bytes));
    }
    c3d.analog.push_back(bits.Part(at, analog_bytes));
    at += analog_bytes;
  }
  c3d.behind = file.substr(at);
  return c3d;
}

}  // namespace mmm_converter::testing
