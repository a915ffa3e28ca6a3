// SPDX-License-Identifier: MIT
#include "common/io/recording/recording_formats.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "common/io/bvh/bvh.h"
#include "common/io/bytes/file_content.h"
#include "common/io/bytes/foreign_content.h"
#include "common/io/c3d/c3d_content.h"
#include "common/io/mmm/mmm_content.h"
#include "common/io/mmm/mmm_motion.h"
#include "common/io/npz/npz_content.h"
#include "common/io/npz/npz_file.h"
#include "common/io/tables/motive_csv.h"
#include "common/io/tables/nexus_csv.h"
#include "common/io/tables/points_csv.h"
#include "common/io/tables/qtm_tsv.h"
#include "common/io/tables/table_content.h"
#include "common/io/tables/trc_reader.h"
#include "common/io/xml/xml_text.h"
#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

constexpr std::size_t kStartBytes = 4096;
constexpr std::size_t kForeignBytes = 1 << 16;  // C3D may begin with half as many zeros
constexpr std::size_t kMostBytesBeforeTheRoot = 1 << 20;

bool IsText(std::string_view start) {
  return std::all_of(start.begin(), start.end(), [](char c) {
    return static_cast<unsigned char>(c) >= 0x20 || c == '\t' || c == '\n' || c == '\r' ||
           c == '\f';
  });
}

bool IsMarkup(std::string_view start) {
  return IsText(start) &&
         Trim(start.substr(start.starts_with("\xEF\xBB\xBF") ? 3 : 0)).starts_with('<');
}

bool IsC3d(const std::string& /*file*/, std::string_view start) {
  return !IsText(start) && LooksLikeC3d(start);
}

template <bool (*kLooksLike)(std::string_view)>
bool IsTable(const std::string& /*file*/, std::string_view start) {
  return IsText(start) && !IsMarkup(start) && kLooksLike(start);
}

// Names of points make long header rows.
bool IsPoints(const std::string& file, std::string_view start) {
  return IsText(start) && !IsMarkup(start) &&
         LooksLikePointsCsv(ReadFileStart(file, kMostBytesBeforeTheRoot));
}

bool IsMmm(const std::string& file, std::string_view start) {
  return IsMarkup(start) && LooksLikeMmmMotion(ReadFileStart(file, kMostBytesBeforeTheRoot));
}

bool IsNpz(const std::string& file, std::string_view start) {
  return LooksLikeNpz(start) && HoldsMotion(file);
}

bool IsNpy(const std::string& /*file*/, std::string_view start) { return LooksLikeNpy(start); }

// A number takes four bytes in C3D, nine in tables, and with its markup fifty in MMM.
const std::vector<RecordingFormat> kFormats = {
    {"C3D", {".c3d"}, IsC3d, ReadC3dContent, 8, true},
    {"TRC", {".trc"}, IsTable<LooksLikeTrc>, ReadTrcContent, 5, true},
    {"Nexus CSV", {".csv"}, IsTable<LooksLikeNexusCsv>, ReadNexusCsvContent, 5, false, false, true},
    {"Motive CSV",
     {".csv"},
     IsTable<LooksLikeMotiveCsv>,
     ReadMotiveCsvContent,
     5,
     false,
     false,
     true},
    {"QTM TSV", {".tsv"}, IsTable<LooksLikeQtmTsv>, ReadQtmTsvContent, 5, false, false, true},
    {"CSV of points", {".csv"}, IsPoints, ReadPointsCsvContent, 5, false, false, true},
    {"BVH", {".bvh"}, IsTable<LooksLikeBvh>, ReadBvhContent, 9},
    {"AMASS", {".npz"}, IsNpz, ReadNpzContent, 9, false, false, true},
    {"NPY of joints", {".npy"}, IsNpy, ReadNpyContent, 9, false, false, true},
    {"MMM motion", {".xml"}, IsMmm, ReadMmmContent, 2, true, true},
};

[[noreturn]] void ThrowOtherText(const std::string& file, std::string_view start) {
  if (IsMarkup(start)) {
    const std::string head = ReadFileStart(file, kMostBytesBeforeTheRoot);
    throw Error(
        fmt::format("{}: is XML or a web page with the root <{}>, not an MMM motion (<MMM>)", file,
                    RootName(head).substr(0, 40)));
  }
  if (start.starts_with("version https://git-lfs")) {
    throw Error(fmt::format(
        "{}: is a Git LFS pointer, not the file itself; fetch that one (git lfs pull)", file));
  }
  const std::string foreign = NameForeignContent(start);
  if (!foreign.empty()) throw Error(fmt::format("{}: {}", file, foreign));
  throw Error(
      fmt::format("{}: is text, but no recording that is read ({})", file, RecordingFormatNames()));
}

/// Lines of printable characters but for some zeros; other formats begin with many.
bool IsDamagedText(std::string_view start) {
  constexpr double kPrintable = 0.95;
  const auto printable = std::count_if(start.begin(), start.end(), [](unsigned char c) {
    return c == '\t' || c == '\r' || c == '\n' || (c >= 0x20 && c < 0x7F);
  });
  return start.find('\n') != std::string_view::npos && start.find('\0') != std::string_view::npos &&
         static_cast<double>(printable) > kPrintable * static_cast<double>(start.size());
}

const RecordingFormat* FindFormat(const std::string& file, std::string_view start) {
  const auto found =
      std::find_if(kFormats.begin(), kFormats.end(),
                   [&](const RecordingFormat& format) { return format.looks_like(file, start); });
  return found == kFormats.end() ? nullptr : &*found;
}

}  // namespace

const std::vector<RecordingFormat>& RecordingFormats() { return kFormats; }

std::string RecordingFormatNames() {
  std::vector<std::string> names;
  for (const RecordingFormat& format : kFormats) names.emplace_back(format.name);
  return JoinNames(names);
}

const RecordingFormat* FindFormatOfName(const std::string& file) {
  const std::string ending = ToLower(std::filesystem::path(file).extension().string());
  for (const RecordingFormat& format : kFormats) {
    for (const char* known : format.endings) {
      if (ending == known) return &format;
    }
  }
  return nullptr;
}

const RecordingFormat* FindFormatOfContent(const std::string& file) {
  return FindFormat(file, ReadFileStart(file, kStartBytes));
}

const RecordingFormat& FormatOfContent(const std::string& file) {
  const std::string start = ReadFileStart(file, kStartBytes);
  if (const RecordingFormat* format = FindFormat(file, start)) return *format;
  if (IsText(start)) ThrowOtherText(file, start);
  if (LooksLikeNpz(start)) return *FindFormatOfName("a.npz");  // whose reader says what is missing
  const std::string foreign = NameForeignContent(ReadFileStart(file, kForeignBytes));
  if (!foreign.empty()) throw Error(fmt::format("{}: {}", file, foreign));
  if (IsDamagedText(start)) {
    throw Error(
        fmt::format("{}: is text with bytes that no text has, the first at byte {}; save or "
                    "export it again",
                    file, start.find('\0') + 1));
  }
  return kFormats.front();  // C3D, whose reader says what is wrong with the bytes
}

}  // namespace mmm_converter
