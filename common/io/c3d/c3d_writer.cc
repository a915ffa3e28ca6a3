// SPDX-License-Identifier: MIT
#include "common/io/c3d/c3d_writer.h"

#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <string_view>
#include <vector>

#include "common/io/c3d/c3d_numbers.h"
#include "common/support/atomic_file.h"
#include "common/support/error.h"
#include "common/support/text_pieces.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

constexpr int kLabelsPerParameter = 255;
constexpr std::size_t kMaxLabelLength = 127;  // so that 255 labels fit behind a 16 bit offset
constexpr std::size_t kMaxParameterBlocks = 255;
constexpr long kLastFrame = 4294967295;  // two words

void AppendWord(std::string* bytes, int word) {
  bytes->push_back(static_cast<char>(word & 0xFF));
  bytes->push_back(static_cast<char>(word >> 8 & 0xFF));
}

void AppendFloat(std::string* bytes, double value) {
  const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(value));
  AppendWord(bytes, static_cast<int>(bits & 0xFFFF));
  AppendWord(bytes, static_cast<int>(bits >> 16));
}

/// The parameter section, record by record.
class ParameterSection {
 public:
  void BeginGroup(std::string_view name) {
    --group_;
    AppendRecord(name, group_, std::string(1, '\0'));  // no description
  }
  void AddWords(std::string_view name, std::initializer_list<int> words) {
    std::string data;
    for (const int word : words) AppendWord(&data, word);
    AddParameter(name, 2, words.size() == 1 ? std::vector<int>() : Dimensions({words.size()}),
                 data);
  }
  void AddFloat(std::string_view name, double value) {
    std::string data;
    AppendFloat(&data, value);
    AddParameter(name, 4, {}, data);
  }
  void AddText(std::string_view name, const std::string& text) {
    AddParameter(name, -1, Dimensions({text.size()}), text);
  }
  void AddTexts(std::string_view name, const std::vector<std::string>& texts) {
    std::size_t width = 1;
    for (const std::string& text : texts) width = std::max(width, text.size());
    std::string data;
    for (const std::string& text : texts) data += text + std::string(width - text.size(), ' ');
    AddParameter(name, -1, Dimensions({width, texts.size()}), data);
  }
  /// Padded to whole blocks, with the section's own header.
  std::string Finish() const {
    std::string section("\x01\x50\x00\x54", 4);
    section += records_;
    section.append(2, '\0');  // end of the records
    section.resize((section.size() + kBlock - 1) / kBlock * kBlock, '\0');
    section[2] = static_cast<char>(section.size() / kBlock);
    return section;
  }

 private:
  static std::vector<int> Dimensions(std::initializer_list<std::size_t> sizes) {
    return {sizes.begin(), sizes.end()};
  }
  void AddParameter(std::string_view name, int type, const std::vector<int>& dimensions,
                    const std::string& data) {
    std::string content;
    content.push_back(static_cast<char>(type));
    content.push_back(static_cast<char>(dimensions.size()));
    for (const int size : dimensions) content.push_back(static_cast<char>(size));
    content += data;
    content.push_back('\0');  // no description
    AppendRecord(name, -group_, content);
  }
  void AppendRecord(std::string_view name, int id, const std::string& content) {
    records_.push_back(static_cast<char>(name.size()));
    records_.push_back(static_cast<char>(id));
    records_ += name;
    AppendWord(&records_, static_cast<int>(content.size() + 2));
    records_ += content;
  }

  int group_ = 0;
  std::string records_;
};

void CheckFits(const std::string& path, const MarkerSequence& markers,
               const C3dWriteOptions& options) {
  const auto refuse = [&](const std::string& why) {
    throw Error(fmt::format("{}: can't be written as C3D: {}", path, why));
  };
  if (markers.num_frames() == 0) refuse("there is no frame");
  if (markers.num_labels() == 0) refuse("there is no marker");
  if (markers.num_labels() > kFullWord) {
    refuse(fmt::format("{} markers; at most {} fit", markers.num_labels(), kFullWord));
  }
  for (const std::string& label : markers.labels()) {
    if (label.size() > kMaxLabelLength) {
      refuse(fmt::format("label {} has more than {} characters", label, kMaxLabelLength));
    }
  }
  if (options.comment.size() > 255) refuse("the comment has more than 255 characters");
  if (options.first_frame < 1 || options.first_frame > kLastFrame - markers.num_frames()) {
    refuse(fmt::format("first frame {}; the last one must be below {}", options.first_frame,
                       kLastFrame));
  }
}

void AddPointGroup(const MarkerSequence& markers, double scale, int data_block,
                   ParameterSection* section) {
  const std::vector<std::string>& labels = markers.labels();
  section->BeginGroup("POINT");
  section->AddWords("USED", {markers.num_labels()});
  section->AddFloat("SCALE", -scale);
  section->AddFloat("RATE", markers.rate());
  section->AddWords("DATA_START", {data_block});
  section->AddWords("FRAMES", {std::min(markers.num_frames(), kFullWord)});
  if (markers.num_frames() > kFullWord) section->AddFloat("LONG_FRAMES", markers.num_frames());
  section->AddText("UNITS", "mm");
  section->AddText("X_SCREEN", "+X");
  section->AddText("Y_SCREEN", "+Z");
  for (std::size_t i = 0; i < labels.size(); i += kLabelsPerParameter) {
    const std::size_t end = std::min(labels.size(), i + kLabelsPerParameter);
    const std::size_t number = i / kLabelsPerParameter + 1;
    section->AddTexts(number == 1 ? "LABELS" : fmt::format("LABELS{}", number),
                      {labels.begin() + static_cast<std::ptrdiff_t>(i),
                       labels.begin() + static_cast<std::ptrdiff_t>(end)});
  }
}

std::string FormatParameters(const MarkerSequence& markers, const C3dWriteOptions& options,
                             double scale, int data_block) {
  ParameterSection section;
  AddPointGroup(markers, scale, data_block, &section);
  section.BeginGroup("ANALOG");
  section.AddWords("USED", {0});
  section.AddFloat("RATE", markers.rate());
  section.BeginGroup("TRIAL");
  const long last = options.first_frame + markers.num_frames() - 1;
  section.AddWords("ACTUAL_START_FIELD", {static_cast<int>(options.first_frame % 65536),
                                          static_cast<int>(options.first_frame / 65536)});
  section.AddWords("ACTUAL_END_FIELD",
                   {static_cast<int>(last % 65536), static_cast<int>(last / 65536)});
  section.BeginGroup("MANUFACTURER");
  section.AddText("COMPANY", "MMMConverterS2KF");
  if (!options.comment.empty()) section.AddText("COMMENT", options.comment);
  return section.Finish();
}

std::string FormatHeader(const MarkerSequence& markers, const C3dWriteOptions& options,
                         double scale, int data_block) {
  const long last = options.first_frame + markers.num_frames() - 1;
  std::string header("\x02\x50", 2);
  AppendWord(&header, markers.num_labels());
  AppendWord(&header, 0);                                    // analog samples
  const bool is_counted = options.first_frame <= kFullWord;  // else words have what is left
  AppendWord(&header, static_cast<int>(options.first_frame % 65536));
  AppendWord(&header,
             static_cast<int>(is_counted ? std::min<long>(last, kFullWord) : last % 65536));
  AppendWord(&header, 0);  // longest filled gap
  AppendFloat(&header, -scale);
  AppendWord(&header, data_block);
  AppendWord(&header, 0);  // analog samples per frame and channel
  AppendFloat(&header, markers.rate());
  header.resize(kBlock, '\0');
  return header;
}

/// Scale for the residuals, and for who wants to make integers of the coordinates.
double ScaleOf(const MarkerSequence& markers) {
  double largest = 0;
  for (int k = 0; k < markers.num_frames(); ++k) {
    const auto frame = markers.frame(k);
    for (int i = 0; i < frame.cols(); ++i) {
      if (IsSeen(frame.col(i))) largest = std::max(largest, frame.col(i).cwiseAbs().maxCoeff());
    }
  }
  return largest > 0 ? largest * kMillimetres / 32000 : 1;
}

void AppendFrame(const Eigen::Ref<const Eigen::Matrix3Xd>& frame, std::string* bytes) {
  for (int i = 0; i < frame.cols(); ++i) {
    const bool seen = IsSeen(frame.col(i));
    for (int j = 0; j < 3; ++j) AppendFloat(bytes, seen ? kMillimetres * frame(j, i) : 0);
    AppendFloat(bytes, seen ? 0 : -1);
  }
}

}  // namespace

void WriteC3d(const std::string& path, const MarkerSequence& markers,
              const C3dWriteOptions& options) {
  CheckFits(path, markers, options);
  const double scale = ScaleOf(markers);
  const std::size_t section_bytes = FormatParameters(markers, options, scale, 0).size();
  if (section_bytes > kMaxParameterBlocks * kBlock) {
    throw Error(fmt::format("{}: can't be written as C3D: the labels need {} bytes, at most {} fit",
                            path, section_bytes, kMaxParameterBlocks * kBlock));
  }
  const int data_block = static_cast<int>(2 + section_bytes / kBlock);
  WriteFileAtomically(path, [&](const TextSink& sink) {
    PieceWriter pieces(sink);
    std::string* const bytes = pieces.text();
    *bytes += FormatHeader(markers, options, scale, data_block);
    *bytes += FormatParameters(markers, options, scale, data_block);
    for (int k = 0; k < markers.num_frames(); ++k) {
      AppendFrame(markers.frame(k), bytes);
      pieces.EndPart();
    }
    const std::size_t point_bytes = std::size_t{16} * markers.num_labels() * markers.num_frames();
    bytes->append((kBlock - point_bytes % kBlock) % kBlock, '\0');
    pieces.Flush();
  });
}

}  // namespace mmm_converter
