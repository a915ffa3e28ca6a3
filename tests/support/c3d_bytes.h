// SPDX-License-Identifier: MIT
#pragma once

#include <cstring>
#include <initializer_list>
#include <span>
#include <string>
#include <vector>

#include "common/io/c3d/c3d_parameters.h"

namespace mmm_converter::testing {

/// Bytes of a parameter section, Intel.
class C3dSection {
 public:
  /// offset -1: the right one.
  C3dSection& Group(int id, const std::string& name) {
    return Record(-id, name, std::string(1, '\0'), -1);
  }
  C3dSection& Texts(int group, const std::string& name, int width, const std::string& data,
                    int offset = -1) {
    const int count = static_cast<int>(data.size()) / width;
    return Parameter(group, name, -1, {width, count}, data, offset);
  }
  C3dSection& Word(int group, const std::string& name, std::initializer_list<int> words) {
    std::string data;
    for (const int word : words) {
      data += static_cast<char>(word & 0xFF);
      data += static_cast<char>(word >> 8);
    }
    return Parameter(group, name, 2, {static_cast<int>(words.size())}, data, -1);
  }
  C3dSection& Float(int group, const std::string& name, float value) {
    return Parameter(group, name, 4, {}, BytesOf({value}), -1);
  }
  C3dSection& Floats(int group, const std::string& name, const std::vector<int>& dimensions,
                     const std::vector<float>& values) {
    return Parameter(group, name, 4, dimensions, BytesOf(values), -1);
  }
  C3dSection& Parameter(int group, const std::string& name, int type,
                        const std::vector<int>& dimensions, const std::string& data, int offset) {
    std::string content(1, static_cast<char>(type));
    content += static_cast<char>(dimensions.size());
    for (const int size : dimensions) content += static_cast<char>(size);
    return Record(group, name, content + data + std::string(1, '\0'), offset);
  }
  C3dSection& Append(const std::string& bytes) {
    bytes_ += bytes;
    return *this;
  }
  C3dParameters Parse() {
    warnings = Warnings();
    return {std::span(reinterpret_cast<const unsigned char*>(bytes_.data()), bytes_.size()),
            C3dProcessor::kIntel, &warnings};
  }

  const std::string& bytes() const { return bytes_; }

  static std::string BytesOf(const std::vector<float>& values) {
    std::string bytes(4 * values.size(), '\0');
    std::memcpy(bytes.data(), values.data(), bytes.size());
    return bytes;
  }

  Warnings warnings;

 private:
  C3dSection& Record(int id, const std::string& name, const std::string& content, int offset) {
    if (offset < 0) offset = static_cast<int>(content.size()) + 2;
    bytes_ += static_cast<char>(name.size());
    bytes_ += static_cast<char>(id);
    bytes_ += name;
    bytes_ += static_cast<char>(offset & 0xFF);
    bytes_ += static_cast<char>(offset >> 8);
    bytes_ += content;
    return *this;
  }
  std::string bytes_ = std::string("\x01\x50\x01\x54", 4);
};

/// What a C3D file of floats holds beside its parameters.
struct C3dBytes {
  int points = 0;
  int analog_words = 0;    // of a frame, all channels
  int analog_samples = 0;  // of a frame and channel
  int first_frame = 1;
  float rate = 100;
  std::vector<std::vector<float>> frames =
      {};  // points with x, y, z and word 4, then analog samples

  /// The bytes of the file, Intel; the header's words 150 to 234 are 0.
  std::string File(const C3dSection& section) const {
    constexpr int kBlock = 512;
    std::string parameters = section.bytes();
    parameters.resize((parameters.size() / kBlock + 1) * kBlock);
    parameters[2] = static_cast<char>(parameters.size() / kBlock);
    std::string file(kBlock, '\0');
    file[0] = 2;
    file[1] = 0x50;
    const auto put = [&file](int word, const void* value, std::size_t size) {
      std::memcpy(&file[2 * (static_cast<std::size_t>(word) - 1)], value, size);
    };
    const int last_frame = first_frame + static_cast<int>(frames.size()) - 1;
    const int data_block = 2 + static_cast<int>(parameters.size()) / kBlock;
    const float scale = -1;
    put(2, &points, 2);
    put(3, &analog_words, 2);
    put(4, &first_frame, 2);
    put(5, &last_frame, 2);
    put(7, &scale, 4);
    put(9, &data_block, 2);
    put(10, &analog_samples, 2);
    put(11, &rate, 4);
    file += parameters;
    for (const std::vector<float>& frame : frames) file += C3dSection::BytesOf(frame);
    return file;
  }
};

}  // namespace mmm_converter::testing
