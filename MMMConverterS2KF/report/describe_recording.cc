// SPDX-License-Identifier: MIT
// What is in a recording, also in one that can't be converted.

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "MMMConverterS2KF/report/c3d_details.h"
#include "MMMConverterS2KF/report/describe.h"
#include "MMMConverterS2KF/report/info_markers.h"
#include "MMMConverterS2KF/report/info_prospect.h"
#include "common/io/recording/recording_formats.h"
#include "common/support/advice.h"
#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

/// What a file says before it is known whose markers it has.
struct StoredRecording {
  std::string format;
  int frames = 0;
  double rate = 0;  // [Hz]; 0: not stated
  long first_frame = 1;
  std::string unit;
  std::vector<std::pair<std::string, long>> points = {};  // with how often they are seen
};

/// The markers of a recording, or why there are none.
struct Markers {
  std::shared_ptr<const Recording> recording;
  std::optional<Prospect> prospect;  ///< of its conversion
  std::string failure;
};

/// @throws Error where the user's own options are what fails.
Markers ReadMarkers(const std::string& path, const ReadRecordingOptions& options,
                    Warnings* warnings) {
  try {
    const auto recording =
        std::make_shared<const Recording>(ReadRecording(path, options, warnings));
    InputRequest conversion;
    conversion.file = path;
    conversion.reading = options;
    return {recording, FindProspect(conversion, recording), ""};
  } catch (const Error& error) {
    if (options.subject || options.unit || options.up_axis) throw;
    std::string failure = WithAdvice(error);
    if (failure.starts_with(path + ": ")) failure.erase(0, path.size() + 2);
    return {nullptr, std::nullopt, failure};
  }
}

std::string FormatPoints(const StoredRecording& stored) {
  std::size_t width = 5;
  for (const auto& [label, seen] : stored.points) width = std::max(width, label.size());
  std::string text =
      fmt::format("labels     {}\n  {:<{}}  seen in\n", stored.points.size(), "label", width);
  for (const auto& [label, seen] : stored.points) {
    text += fmt::format("  {:<{}}  {:>7}\n", label, width, seen);
  }
  return text;
}

Json PointsJson(const StoredRecording& stored) {
  Json list = Json::array();
  for (const auto& [label, seen] : stored.points) {
    list.push_back({{"label", label}, {"frames_seen", seen}, {"mean_position_m", nullptr}});
  }
  return list;
}

std::string FormatHead(const std::string& path, const StoredRecording& stored) {
  const std::string rate = stored.rate > 0 ? fmt::format("{:.6g} Hz ({:.3f} s)", stored.rate,
                                                         stored.frames / stored.rate)
                                           : "an unknown rate";
  return fmt::format("{}: {} recording\nframes     {} at {}, the first is number {}\n", path,
                     stored.format, stored.frames, rate, stored.first_frame);
}

const char* UpAxisSource(const Recording& recording) {
  if (recording.stated_up_axis == recording.up_axis) return " (stated by the file)";
  return recording.up_axis_was_decided ? " (decided from the markers)" : "";
}

std::string FormatAxes(const Recording& recording) {
  return fmt::format(
      "unit       {}{}\nup         {}{}\nsubjects   {}\n", recording.unit,
      recording.unit_was_guessed ? " (guessed)" : "", Name(recording.up_axis),
      UpAxisSource(recording),
      recording.subjects.empty() ? "not named" : JoinNames(recording.subjects, ", "));
}

Json RecordingJson(const std::string& path, const StoredRecording& stored, const Markers& markers) {
  Json json = {{"kind", "recording"},
               {"file", path},
               {"format", stored.format},
               {"frames", stored.frames},
               {"rate_hz", stored.rate > 0 ? Json(stored.rate) : Json(nullptr)},
               {"first_frame", stored.first_frame}};
  json["can_be_converted"] = markers.recording != nullptr;
  json["failure"] = TextOrNull(markers.failure);
  if (!markers.recording) {
    json["unit"] = stored.unit;
    json["labels"] = PointsJson(stored);
    return json;
  }
  const Recording& recording = *markers.recording;
  json["unit"] = recording.unit;
  json["unit_guessed"] = recording.unit_was_guessed;
  json["up_axis"] = Name(recording.up_axis);
  json["up_axis_decided_from_markers"] = recording.up_axis_was_decided;
  json["subjects"] = recording.subjects;
  json["subject"] = recording.subject;
  json["conversion"] = ToJson(*markers.prospect);
  json["labels"] = MarkersJson(recording.markers);
  return json;
}

/// content: text between the head and the markers.
Description Describe(const std::string& path, const StoredRecording& stored, const Markers& markers,
                     const std::string& content, const Warnings& warnings, Json json) {
  std::string text = FormatHead(path, stored);
  if (markers.recording) {
    const MarkerSequence& sequence = markers.recording->markers;
    text += FormatAxes(*markers.recording) + FormatProspect(*markers.prospect) + content +
            fmt::format("labels     {}\n{}", sequence.num_labels(), FormatMarkers(sequence));
  } else {
    text += fmt::format("unit       {}\n{}convert    not as it is: {}\n{}",
                        stored.unit.empty() ? "not stated" : stored.unit, content, markers.failure,
                        FormatPoints(stored));
  }
  json["warnings"] = warnings.texts();
  return {text, FormatJson(json), warnings};
}

}  // namespace

Description DescribeC3d(const FileStart& file, const ReadRecordingOptions& options) {
  Warnings warnings;
  C3dFile c3d(file.path, &warnings);
  const C3dDetails details = ReadC3dDetails(&c3d, &warnings);
  const C3dLayout& layout = c3d.layout();
  StoredRecording stored{"C3D", layout.frames, layout.rate, layout.first_frame,
                         c3d.parameters().Text("POINT", "UNITS")};
  for (std::size_t i = 0; i < details.labels.size(); ++i) {
    stored.points.emplace_back(details.labels[i], details.points[i].seen);
  }
  Warnings of_markers;
  const Markers markers = ReadMarkers(file.path, options, &of_markers);
  warnings.AppendNew(of_markers);
  Json json = RecordingJson(file.path, stored, markers);
  AddC3dDetails(c3d, details, &json);
  return Describe(file.path, stored, markers, FormatC3dDetails(c3d, details), warnings,
                  std::move(json));
}

Description DescribeMarkerTable(const FileStart& file, const ReadRecordingOptions& options) {
  Warnings warnings;
  const Markers markers = ReadMarkers(file.path, options, &warnings);
  if (markers.recording) {
    const Recording& recording = *markers.recording;
    const StoredRecording stored{recording.format, recording.markers.num_frames(),
                                 recording.markers.rate(), recording.first_frame, recording.unit};
    return Describe(file.path, stored, markers, "", warnings,
                    RecordingJson(file.path, stored, markers));
  }
  warnings = Warnings();
  const RecordingContent content = FormatOfContent(file.path).read(file.path, {}, &warnings);
  std::vector<int> all(content.labels.size());
  std::iota(all.begin(), all.end(), 0);
  const MarkerSequence sequence = content.read(all, content.labels, content.rate);
  StoredRecording stored{content.format, sequence.num_frames(), content.rate, content.first_frame,
                         content.unit};
  for (int i = 0; i < sequence.num_labels(); ++i) {
    long seen = 0;
    for (int k = 0; k < sequence.num_frames(); ++k) seen += IsSeen(sequence.frame(k).col(i));
    stored.points.emplace_back(content.labels[static_cast<std::size_t>(i)], seen);
  }
  return Describe(file.path, stored, markers, "", warnings,
                  RecordingJson(file.path, stored, markers));
}

}  // namespace mmm_converter
