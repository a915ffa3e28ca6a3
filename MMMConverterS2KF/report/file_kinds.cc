// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/report/file_kinds.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "MMMConverterS2KF/report/describe.h"
#include "common/io/bytes/file_content.h"
#include "common/io/mjcf/mjcf_robot.h"
#include "common/io/recording/recording_formats.h"
#include "common/io/xml/xml_text.h"
#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

constexpr std::size_t kHeadBytes = 1 << 20;

template <const char* const& kRoot>
bool HasRoot(const FileStart& file) {
  return EqualIgnoringCase(file.root, kRoot);
}

constexpr const char* kMotion = "MMM";
constexpr const char* kOsim = "OpenSimDocument";
constexpr const char* kConfiguration = "ConverterConfig";
constexpr const char* kMarkerSet = "MarkerSet";
constexpr const char* kSubject = "Subject";
constexpr const char* kPerson = "ModelProcessorConfig";
constexpr const char* kPage = "html";

bool IsModel(const FileStart& file) {
  return EqualIgnoringCase(file.root, "Robot") || IsMjcf(file.head);
}

bool IsPlugin(const FileStart& file) {
  return file.head.starts_with(
             "\x7f"
             "ELF") ||
         std::filesystem::path(file.path).extension() == ".so";
}

constexpr const char* kC3d = "C3D";

bool IsC3d(const FileStart& file) {
  const RecordingFormat* format = FindFormatOfContent(file.path);
  return format != nullptr && std::string_view(format->name) == kC3d;
}

bool IsMarkerTable(const FileStart& file) {
  const RecordingFormat* format = FindFormatOfContent(file.path);
  return format != nullptr && !format->holds_motions && std::string_view(format->name) != kC3d;
}

bool IsJson(const FileStart& file) { return Trim(file.head).starts_with('{'); }

bool IsSampleSet(const FileStart& file) { return file.head.starts_with("LCD samples of"); }

bool IsText(std::string_view text) {
  return std::none_of(text.begin(), text.end(), [](char c) {
    return static_cast<unsigned char>(c) < 0x20 && c != '\t' && c != '\n' && c != '\r' && c != '\f';
  });
}

// What a file is that none of the kinds recognises.
std::string Otherwise(const FileStart& file) {
  if (file.head.starts_with("version https://git-lfs")) {
    return "is a Git LFS pointer, not the file itself; fetch that one (git lfs pull)";
  }
  if (!file.root.empty()) {
    return fmt::format("is XML or a web page with the root <{}>", file.root.substr(0, 40));
  }
  return IsText(file.head) ? "is text of no known kind" : "is a binary file of no known kind";
}

}  // namespace

const std::vector<FileKind>& FileKinds() {
  static const std::vector<FileKind> kKinds = {
      {"plugins", IsPlugin, DescribePlugin},
      {"MMM motions", HasRoot<kMotion>, DescribeMotions},
      {"models and robots (MMM, URDF, MJCF)", IsModel, DescribeModel},
      {"OpenSim models and set-ups", HasRoot<kOsim>, DescribeOsim},
      {"configurations", HasRoot<kConfiguration>, DescribeConfiguration},
      {"marker sets", HasRoot<kMarkerSet>, DescribeMarkerSet},
      {"subjects", HasRoot<kSubject>, DescribeSubjectFile},
      {"persons (ModelProcessorConfig)", HasRoot<kPerson>, DescribePerson},
      {"pages of this program", HasRoot<kPage>, DescribePage},
      {"C3D recordings", IsC3d, DescribeC3d},
      {"recordings in tables (TRC; exports of Nexus, Motive and QTM; CSV)", IsMarkerTable,
       DescribeMarkerTable},
      {"tables (CSV, MOT)", IsTable, DescribeTable},
      {"arrays (.npz)", IsNpz, DescribeNpz},
      {"skeletons (BVH)", IsBvh, DescribeBvh},
      {"motions of robots (CSV)", IsLafanTable, DescribeLafanTable},
      {"pickles", IsPickle, DescribePickle},
      {"summaries (JSON)", IsJson, DescribeSummary},
      {"sample sets of filters", IsSampleSet, DescribeSampleSet},
  };
  return kKinds;
}

Description DescribeFile(const std::string& path, const ReadRecordingOptions& options,
                         const std::vector<FileKind>& kinds) {
  FileStart file{path, ReadFileStart(path, kHeadBytes), ""};
  file.root = RootName(file.head);
  std::vector<std::string> names;
  for (const FileKind& kind : kinds) {
    if (kind.is(file)) return kind.describe(file, options);
    names.emplace_back(kind.name);
  }
  throw Error(
      fmt::format("{}: {}; known are {}", path, Otherwise(file), JoinNames(names, " and ")));
}

}  // namespace mmm_converter
