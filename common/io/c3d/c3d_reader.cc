// SPDX-License-Identifier: MIT
#include "common/io/c3d/c3d_reader.h"

#include <fmt/core.h>

#include "common/io/c3d/c3d_data.h"
#include "common/io/c3d/c3d_numbers.h"
#include "common/support/error.h"
#include "common/support/text.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

[[noreturn]] void ThrowNoPoints(const C3dParameters& parameters, const std::string& path) {
  const double rotations = parameters.Number("ROTATION", "USED").value_or(0);
  if (rotations >= 1) {
    throw Error(
        fmt::format("{}: the file holds the rotations of {:.0f} segments and no points, as "
                    "markerless systems write it; export points too: joint centres or "
                    "landmarks",
                    path, rotations));
  }
  throw Error(fmt::format("{}: the file holds no points", path));
}

/// A date as text, or as year, month and day.
std::string DateOf(const C3dParameters& parameters) {
  const C3dParameter* date = parameters.Find("TRIAL", "DATE");
  if (date == nullptr || date->num_texts() > 0) return parameters.Text("TRIAL", "DATE");
  const auto year = date->Number(0), month = date->Number(1), day = date->Number(2);
  const auto is_in = [](const std::optional<double>& value, double least, double most) {
    return value && *value >= least && *value <= most;
  };
  if (!is_in(year, 1900, 9999) || !is_in(month, 1, 12) || !is_in(day, 1, 31)) return "";
  return fmt::format("{:04.0f}-{:02.0f}-{:02.0f}", *year, *month, *day);
}

RecordingOrigin OriginOf(const C3dParameters& parameters) {
  const std::string company = parameters.Text("MANUFACTURER", "COMPANY");
  const std::string software = parameters.Text("MANUFACTURER", "SOFTWARE");
  // Of several subjects the file does not say whose markers these are.
  const std::vector<std::string> names = parameters.TextList("SUBJECTS", "NAMES", 2);
  RecordingOrigin origin;
  if (names.size() == 1) origin.subject = ToUtf8(names.front());
  origin.date = ToUtf8(DateOf(parameters));
  origin.system = ToUtf8(company + (company.empty() || software.empty() ? "" : ", ") + software);
  return origin;
}

constexpr double kLightest = 5, kHeaviest = 300;   // [kg] persons
constexpr double kShortest = 0.5, kTallest = 2.5;  // [m]
constexpr double kFewestCentimetres = 80;          // fewer are inches

/// A height in metres, centimetres or millimetres.
std::optional<double> HeightOf(double number) {
  if (number >= kShortest && number <= kTallest) return number;
  if (number >= kFewestCentimetres && number <= 100 * kTallest) return number / 100;
  if (number >= 1000 * kShortest && number <= 1000 * kTallest) return number / 1000;
  return std::nullopt;
}

/// PROCESSING:BODYMASS and HEIGHT of Nexus, and what others call them, also in the group that is
/// named as the only subject. Nothing of several persons, or of none.
BodySize StatedSize(const C3dParameters& parameters) {
  const std::vector<std::string> subjects = parameters.TextList("SUBJECTS", "NAMES", 2);
  BodySize size;
  for (const C3dParameter& one : parameters.all()) {
    const bool is_subjects =
        subjects.size() == 1 && !one.group.empty() && EqualIgnoringCase(one.group, subjects[0]);
    if (!is_subjects && one.group != "PROCESSING" && !one.group.starts_with("SUBJECT") &&
        one.group != "PATIENT") {
      continue;
    }
    if (one.type < 1 || one.size() != 1) continue;
    std::string letters;
    for (const char c : one.name) {
      if (c >= 'A' && c <= 'Z') letters += c;
    }
    const double number = one.Number(0).value_or(0);
    const bool is_mass = letters.find("BODYMASS") != std::string::npos || letters == "MASS" ||
                         letters == "MASSKG" || letters == "WEIGHTKG" || letters == "WEIGHT";
    const bool is_height = letters.find("BODYHEIGHT") != std::string::npos || letters == "HEIGHT" ||
                           letters == "HEIGHTM" || letters == "HEIGHTCM" || letters == "HEIGHTMM" ||
                           letters == "STATURE";
    if (is_mass && !size.mass && number >= kLightest && number <= kHeaviest) size.mass = number;
    if (is_height && !size.height) size.height = HeightOf(number);
  }
  return size;
}

}  // namespace

C3dReader::C3dReader(const std::string& path, Warnings* warnings) : file_(path, warnings) {
  const WarningContext context(warnings, path);
  info_.layout = file_.layout();
  if (info_.layout.points == 0) ThrowNoPoints(file_.parameters(), path);
  if (info_.layout.frames == 0) {
    throw Error(
        fmt::format("{}: no whole frame: {} points need {} bytes a frame, {} bytes follow "
                    "the header and parameters",
                    path, info_.layout.points, info_.layout.frame_bytes, file_.data_bytes()));
  }
  const C3dParameters& parameters = file_.parameters();
  info_.unit = parameters.Text("POINT", "UNITS");
  info_.labels = C3dPointNames(file_, warnings);
  info_.outputs = C3dOutputNames(file_);
  info_.label_prefixes = parameters.TextList("SUBJECTS", "LABEL_PREFIXES", info_.labels.size());
  info_.comment = parameters.Text("MANUFACTURER", "COMMENT");
  info_.origin = OriginOf(parameters);
  info_.up = parameters.Text("POINT", "Y_SCREEN");
  info_.stated_size = StatedSize(parameters);
}

MarkerSequence C3dReader::ReadPoints(const std::vector<int>& points,
                                     const std::vector<std::string>& labels, double rate,
                                     bool ignore_residuals) {
  const C3dLayout& layout = info_.layout;
  MarkerSequence sequence(labels, layout.frames, rate, layout.first_time(rate));
  if (points.empty()) return sequence;
  file_.ReadAllFrames([&](int first, int count, const unsigned char* stored) {
    DecodeC3dFrames(stored, count, points, layout, ignore_residuals, sequence.frame(first).data());
  });
  return sequence;
}

std::vector<C3dPoint> C3dReader::ReadFrame(int frame) {
  const C3dLayout& layout = info_.layout;
  std::vector<unsigned char> bytes;
  file_.ReadFrames(frame, 1, &bytes);
  std::vector<C3dPoint> points(layout.points);
  const int point_bytes = layout.floats ? 16 : 8;
  for (int i = 0; i < layout.points; ++i) {
    const unsigned char* stored = &bytes[static_cast<std::size_t>(i) * point_bytes];
    const C3dPointWord word = DecodeC3dPointWord(stored, layout);
    DecodeC3dPosition(stored, layout, points[i].position.data());
    points[i].valid = word.valid && points[i].position.allFinite();
    if (!points[i].valid) continue;
    points[i].residual = word.known ? word.residual * layout.scale : kNaN;
    points[i].cameras = word.cameras;
  }
  return points;
}

}  // namespace mmm_converter
