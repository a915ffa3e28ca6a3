// SPDX-License-Identifier: MIT
#include "common/pipeline/labelled_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <set>
#include <string_view>

#include "common/io/bytes/file_content.h"
#include "common/io/c3d/c3d_file.h"
#include "common/io/c3d/c3d_relabelling.h"
#include "common/io/c3d/c3d_writer.h"
#include "common/io/mmm/mmm_motion.h"
#include "common/io/recording/recording_formats.h"
#include "common/io/tables/trc_writer.h"
#include "common/pipeline/person_calibration.h"
#include "common/support/advice.h"
#include "common/support/atomic_file.h"
#include "common/support/error.h"

namespace mmm_converter {
namespace {

// What the file's labels have before a name of the recording's subject: "Anna:".
std::string PrefixOf(const Recording& recording, const std::vector<std::string>& file_labels) {
  for (int i = 0; i < recording.markers.num_labels(); ++i) {
    const std::string& name = recording.markers.labels()[i];
    const std::string& label = file_labels[recording.points[i]];
    if (!name.starts_with('*') && label.ends_with(name)) {
      return label.substr(0, label.size() - name.size());
    }
  }
  return "";
}

C3dRelabelledPoint ToC3d(const RelabelledPoint& point, const Recording& recording,
                         const std::vector<std::string>& file_labels, const std::string& prefix) {
  C3dRelabelledPoint out;
  out.like = recording.points[point.place];
  const bool is_as_before = point.label == recording.markers.labels()[point.place];
  const bool needs_prefix = point.is_named && point.label.find(':') == std::string::npos;
  out.label = is_as_before ? file_labels[out.like] : (needs_prefix ? prefix : "") + point.label;
  for (const PointStretch& one : point.stretches) {
    out.stretches.push_back({one.begin, one.end, recording.points[one.from]});
  }
  return out;
}

/// All points of the file: those that are not the recording's stay as they are.
std::vector<C3dRelabelledPoint> PointsOfFile(const LabelReport& report) {
  const Recording& recording = report.input.recording;
  const C3dFile file(recording.file);
  const std::vector<std::string> labels = C3dPointNames(file, nullptr);
  const std::string prefix = PrefixOf(recording, labels);
  std::vector<bool> is_of_recording(labels.size(), false);
  for (const int point : recording.points) is_of_recording[point] = true;
  std::vector<C3dRelabelledPoint> points;
  auto next = report.found.points.begin();
  for (std::size_t p = 0; p < labels.size(); ++p) {
    const int point = static_cast<int>(p);
    if (!is_of_recording[p]) {
      points.push_back({labels[p], point, {{0, recording.markers.num_frames(), point}}});
    }
    for (; next != report.found.points.end() && recording.points[next->place] == point; ++next) {
      points.push_back(ToC3d(*next, recording, labels, prefix));
    }
  }
  return points;
}

// C3D has no times: the first frame has the number that a capture from 0 s on gives it.
long FirstFrame(const MarkerSequence& markers) {
  constexpr double kMost = 1e9;
  const double number = std::round(markers.first_time() * markers.rate()) + 1;
  return number >= 1 && number <= kMost ? static_cast<long>(number) : 1;
}

void WriteAsC3d(const LabelReport& report, const MarkerSequence& markers) {
  const Recording& recording = report.input.recording;
  if (recording.format == "C3D") {
    WriteRelabelledC3d(recording.file, PointsOfFile(report), report.output);
  } else {
    WriteC3d(report.output, markers, {.first_frame = FirstFrame(markers)});
  }
}

void WriteAsTrc(const LabelReport& report, const MarkerSequence& markers) {
  TrcOutput trc;
  trc.file_name = std::filesystem::path(report.output).filename().string();
  trc.first_frame = report.input.recording.first_frame;
  trc.measured = &markers;
  WriteFileAtomically(report.output, FormatTrc(trc));
}

void WriteAsMmm(const LabelReport& report, const MarkerSequence& markers) {
  const Recording& recording = report.input.recording;
  MmmMotionOutput motion;
  motion.recording_name = std::filesystem::path(recording.file).stem().string();
  motion.motion_name = recording.motion().empty() ? SubjectName(report.input) : recording.motion();
  motion.markers = &markers;
  WriteFileAtomically(report.output, recording.format == "MMM 2.0"
                                         ? WithConvertedMotions(BytesOfFile(recording.file),
                                                                recording.file, {motion})
                                         : FormatMmmMotion2(motion));
}

// How a recording under the names that were found is written in a format of the table of formats.
struct LabelledFormat {
  std::string_view format;
  bool holds_several;  // bodies, whose names stand before their labels
  void (*write)(const LabelReport& report, const MarkerSequence& markers);
};

constexpr std::array kLabelledFormats = {LabelledFormat{"C3D", true, WriteAsC3d},
                                         LabelledFormat{"TRC", true, WriteAsTrc},
                                         LabelledFormat{"MMM motion", false, WriteAsMmm}};

// By the name of the file; null: none.
const LabelledFormat* FindLabelledFormat(const std::string& file) {
  const RecordingFormat* format = FindFormatOfName(file);
  const auto* const found = std::find_if(
      kLabelledFormats.begin(), kLabelledFormats.end(),
      [&](const LabelledFormat& one) { return format != nullptr && one.format == format->name; });
  return found == kLabelledFormats.end() ? nullptr : found;
}

bool IsOfFormat(const std::string& file, std::string_view name) {
  const LabelledFormat* format = FindLabelledFormat(file);
  return format != nullptr && format->format == name;
}

}  // namespace

void CheckLabelledOutput(const std::string& file, bool of_several) {
  const LabelledFormat* format = FindLabelledFormat(file);
  if (format == nullptr) {
    throw Error(fmt::format(
        "{}: the name must end as that of a recording: .c3d, .trc or .xml (an MMM motion)", file));
  }
  if (!of_several || format->holds_several) return;
  throw Error(fmt::format(
      "{}: labels of several persons or objects go to a .c3d or .trc; each is then a {} of it",
      file, OptionText("subject")));
}

void CheckKeepsRecording(const std::string& file, const Recording& recording) {
  std::error_code failure;
  if (!std::filesystem::equivalent(file, recording.file, failure)) return;
  const bool is_of_mmm = recording.format == "MMM 2.0" && IsOfFormat(file, "MMM motion");
  if (is_of_mmm || IsOfFormat(file, recording.format)) return;
  throw Error(
      fmt::format("{}: is the recording itself, which would be lost; give another file", file));
}

std::set<std::string> NamesThatStay(const std::string& file, const Recording& recording) {
  if (recording.format != "C3D" || !IsOfFormat(file, "C3D")) return {};
  const std::vector<std::string> labels = C3dPointNames(C3dFile(recording.file), nullptr);
  const std::string prefix = PrefixOf(recording, labels);
  std::vector<bool> is_of_recording(labels.size(), false);
  for (const int point : recording.points) is_of_recording[point] = true;
  std::set<std::string> names;
  for (std::size_t p = 0; p < labels.size(); ++p) {
    if (is_of_recording[p]) continue;
    // As ToC3d gives labels: a name with a colon as it is, others behind the prefix.
    if (labels[p].find(':') != std::string::npos) names.insert(labels[p]);
    if (labels[p].starts_with(prefix)) names.insert(labels[p].substr(prefix.size()));
  }
  for (const std::string& name : recording.markers.labels()) names.erase(name);
  return names;
}

void WriteLabelled(const LabelReport& report) {
  FindLabelledFormat(report.output)
      ->write(report, Relabelled(report.found.points, report.input.recording.markers));
}

}  // namespace mmm_converter
