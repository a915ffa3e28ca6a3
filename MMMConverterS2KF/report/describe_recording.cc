// SPDX-License-Identifier: MIT
// What is in a recording, also in one that can't be converted.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "MMMConverterS2KF/report/describe.h"
#include "MMMConverterS2KF/report/info_markers.h"
#include "MMMConverterS2KF/report/json.h"
#include "MMMConverterS2KF/report/names_summary.h"
#include "common/convert/marker_mapping.h"
#include "common/forces/plate_forces.h"
#include "common/io/c3d/c3d_analog.h"
#include "common/io/c3d/c3d_events.h"
#include "common/io/c3d/c3d_points.h"
#include "common/io/recording/recording_formats.h"
#include "common/pipeline/conversion.h"
#include "common/pipeline/input/input.h"
#include "common/study/coverage.h"
#include "common/support/advice.h"
#include "common/support/error.h"
#include "common/support/text.h"
#include "common/support/warnings.h"

namespace mmm_converter {
namespace {

/// What a C3D file holds, whether or not it is a recording of markers.
struct C3dDetails {
  std::vector<std::string> labels;  ///< of points
  std::vector<std::string> outputs;
  std::vector<C3dPointCounts> points;
  C3dAnalog analog;
  std::vector<C3dEvent> events;
  std::vector<C3dForcePlate> plates;
  RecordedForces forces;  ///< of those plates that can be read
};

/// Bounds the values that are listed: the section of a real file has 130 kB at most, that of a
/// hostile one can have tens of millions of numbers.
constexpr std::size_t kMostBytes = 1 << 20;

const char* ProcessorName(C3dProcessor processor) {
  switch (processor) {
    case C3dProcessor::kDec:
      return "DEC";
    case C3dProcessor::kMips:
      return "MIPS";
    default:
      return "Intel";
  }
}

/// Parameters worth a line, where a file has them.
constexpr std::pair<const char*, const char*> kShownParameters[] = {
    {"MANUFACTURER", "COMPANY"},     {"MANUFACTURER", "SOFTWARE"}, {"MANUFACTURER", "COMMENT"},
    {"SUBJECTS", "NAMES"},           {"SUBJECTS", "MARKER_SETS"},  {"POINT", "UNITS"},
    {"POINT", "X_SCREEN"},           {"POINT", "Y_SCREEN"},        {"TRIAL", "DATE"},
    {"TRIAL", "ACTUAL_START_FIELD"}, {"TRIAL", "ACTUAL_END_FIELD"}};

/// Words are signed, but where the format counts points and frames with them.
double NumberOf(const C3dParameter& parameter, std::size_t index) {
  const double number = *parameter.Number(index);
  const bool is_count = parameter.group == "POINT" || parameter.group == "TRIAL";
  return parameter.type == 2 && !is_count && number > INT16_MAX ? number - (UINT16_MAX + 1)
                                                                : number;
}

std::string FirstValues(const C3dParameter& parameter) {
  constexpr std::size_t kMost = 8;
  if (parameter.type == -1) return FirstNames(parameter.Texts(kMost + 1), kMost);
  std::string text;
  for (std::size_t i = 0; i < std::min(parameter.size(), kMost); ++i) {
    text += fmt::format("{}{:.6g}", i == 0 ? "" : " ", NumberOf(parameter, i));
  }
  return parameter.size() > kMost ? text + " ..." : text;
}

std::string FormatParameters(const C3dParameters& parameters) {
  std::map<std::string, int> counts;
  for (const C3dParameter& parameter : parameters.all()) ++counts[parameter.group];
  std::vector<std::string> groups;
  groups.reserve(counts.size());
  for (const auto& [group, count] : counts) {
    groups.push_back(fmt::format("{} {}", group.empty() ? "(no group)" : group, count));
  }
  std::string text = fmt::format("parameters {} in {} groups: {}\n", parameters.all().size(),
                                 parameters.groups().size(), FirstNames(groups, 40));
  for (const auto& [group, name] : kShownParameters) {
    const C3dParameter* const parameter = parameters.Find(group, name);
    if (parameter == nullptr) continue;
    const std::string values = FirstValues(*parameter);
    if (!values.empty()) {
      text += fmt::format("  {:<24} {}\n", fmt::format("{}:{}", group, name), values);
    }
  }
  return text;
}

Json ParametersJson(const C3dParameters& parameters) {
  Json groups = Json::object();
  for (const std::string& group : parameters.groups()) groups[group] = Json::object();
  std::size_t bytes = 0;
  for (const C3dParameter& parameter : parameters.all()) {
    Json& group = groups[parameter.group];
    if (group.is_object() && group.contains(parameter.name)) continue;  // the first counts
    bytes += parameter.data.size();
    if (bytes > kMostBytes) {
      group[parameter.name] = nullptr;
      continue;
    }
    if (parameter.type == -1) {
      group[parameter.name] = parameter.Texts(parameter.num_texts());
      continue;
    }
    Json values = Json::array();
    for (std::size_t i = 0; i < parameter.size(); ++i) {
      const double number = NumberOf(parameter, i);
      if (parameter.type == 4) {
        values.push_back(std::isfinite(number) ? Json(static_cast<float>(number)) : nullptr);
      } else {
        values.push_back(static_cast<int>(number));
      }
    }
    group[parameter.name] = std::move(values);
  }
  return groups;
}

bool IsLabelled(const std::string& label) { return !label.starts_with('*'); }

struct LabelCounts {
  int outputs = 0;  // angles, forces, ...
  int labelled = 0;
  int unlabelled = 0;
  int seen = 0;  // in any frame
};

LabelCounts CountLabels(const C3dDetails& details) {
  const std::set<std::string> outputs(details.outputs.begin(), details.outputs.end());
  LabelCounts counts;
  for (std::size_t i = 0; i < details.labels.size(); ++i) {
    const std::string& label = details.labels[i];
    ++(outputs.count(label) > 0 ? counts.outputs
       : IsLabelled(label)      ? counts.labelled
                                : counts.unlabelled);
    counts.seen += details.points[i].seen > 0;
  }
  return counts;
}

Json AnalogJson(const C3dAnalog& analog) {
  Json channels = Json::array();
  for (const C3dAnalogChannel& channel : analog.channels) {
    channels.push_back(
        {{"label", channel.label}, {"unit", channel.unit}, {"description", channel.description}});
  }
  return {{"rate_hz", Number(analog.rate)},
          {"samples_per_frame", analog.samples_per_frame},
          {"channels", channels}};
}

std::string FormatAnalog(const C3dAnalog& analog) {
  if (analog.channels.empty()) return "analog     none\n";
  std::vector<std::string> names;
  for (const C3dAnalogChannel& channel : analog.channels) {
    names.push_back(channel.unit.empty() ? channel.label
                                         : fmt::format("{} [{}]", channel.label, channel.unit));
  }
  return fmt::format("analog     {} channels at {:.6g} Hz ({} samples a frame): {}\n",
                     analog.channels.size(), analog.rate, analog.samples_per_frame,
                     FirstNames(names));
}

/// The capture's number of the frame at a time; nothing where no rate is known.
std::optional<long> FrameAt(double time, const C3dLayout& layout) {
  const double frame = std::round(time * layout.rate) + 1;
  if (!(layout.rate > 0) || !(std::abs(frame) < 1e12)) return std::nullopt;
  return static_cast<long>(frame);
}

std::string FormatEvents(const std::vector<C3dEvent>& events, const C3dLayout& layout) {
  std::string text =
      events.empty() ? "events     none\n" : fmt::format("events     {}\n", events.size());
  for (const C3dEvent& event : events) {
    const std::optional<long> frame = FrameAt(event.time, layout);
    text += fmt::format(
        "  {:9.3f} s  {}{}{}{}{}\n", event.time, frame ? fmt::format("frame {}  ", *frame) : "",
        event.label, event.context.empty() ? "" : ", " + event.context,
        event.subject.empty() ? "" : ", " + event.subject, event.is_in_header ? " (header)" : "");
  }
  return text;
}

const PlateForces* ForcesOf(const RecordedForces& forces, std::size_t plate) {
  for (const PlateForces& one : forces.plates) {
    if (one.plate.number == static_cast<int>(plate) + 1) return &one;
  }
  return nullptr;
}

/// The time of a sample [s], counted as markers' frames are from the beginning of the capture.
double TimeOf(int sample, const C3dLayout& layout, const RecordedForces& forces) {
  const double start = layout.rate > 0 ? (layout.first_frame - 1) / layout.rate : 0;
  return start + (forces.rate > 0 ? sample / forces.rate : 0);
}

std::string FormatLoads(const PlateForces& plate, const C3dLayout& layout,
                        const RecordedForces& forces) {
  std::string text =
      fmt::format("     at most {:.0f} N, {}", plate.largest_load,
                  plate.is_seen_unloaded ? fmt::format("unloaded {:.1f} N", plate.unloaded_level)
                                         : "never unloaded");
  for (std::size_t i = 0; i < plate.loads.size(); ++i) {
    text += fmt::format("{} {:.3f} to {:.3f} s", i == 0 ? "; loaded" : ",",
                        TimeOf(plate.loads[i].begin, layout, forces),
                        TimeOf(plate.loads[i].end, layout, forces));
  }
  return text + "\n";
}

std::string FormatPlates(const C3dLayout& layout, const C3dDetails& details) {
  const std::vector<C3dForcePlate>& plates = details.plates;
  std::string text =
      plates.empty() ? "plates     none\n" : fmt::format("plates     {}\n", plates.size());
  for (std::size_t i = 0; i < plates.size(); ++i) {
    const C3dForcePlate& plate = plates[i];
    text += fmt::format("  {}  type {}, {} channels", i + 1, plate.type, plate.channels.size());
    if (plate.corners) {
      text += ", corners";
      for (int c = 0; c < 4; ++c) {
        const Eigen::Vector3d p = plate.corners->col(c);
        text += fmt::format(" ({:.6g} {:.6g} {:.6g})", p.x(), p.y(), p.z());
      }
    }
    text += "\n";
    if (const PlateForces* forces = ForcesOf(details.forces, i)) {
      text += FormatLoads(*forces, layout, details.forces);
    }
  }
  return text;
}

void AddLoads(const PlateForces& plate, const C3dLayout& layout, const RecordedForces& forces,
              Json* json) {
  Json loads = Json::array();
  for (const LoadInterval& load : plate.loads) {
    loads.push_back({{"begin_s", Number(TimeOf(load.begin, layout, forces))},
                     {"end_s", Number(TimeOf(load.end, layout, forces))}});
  }
  (*json)["largest_load_N"] = Number(plate.largest_load);
  (*json)["unloaded_N"] = plate.is_seen_unloaded ? Number(plate.unloaded_level) : Json(nullptr);
  (*json)["reversed"] = plate.is_reversed;
  (*json)["tells_contact"] = plate.tells_contact;
  (*json)["loads"] = std::move(loads);
}

Json PlatesJson(const C3dLayout& layout, const C3dDetails& details) {
  Json list = Json::array();
  for (const C3dForcePlate& plate : details.plates) {
    Json corners = nullptr;
    for (int c = 0; plate.corners && c < 4; ++c) {
      const Eigen::Vector3d p = plate.corners->col(c);
      corners.push_back({Number(p.x()), Number(p.y()), Number(p.z())});
    }
    list.push_back({{"type", plate.type}, {"channels", plate.channels}, {"corners", corners}});
    if (const PlateForces* forces = ForcesOf(details.forces, list.size() - 1)) {
      AddLoads(*forces, layout, details.forces, &list.back());
    }
  }
  return list;
}

Json CountsJson(const C3dPointCounts& counts) {
  return {{"seen", counts.seen},
          {"marked_invalid", counts.marked_invalid},
          {"at_origin", counts.at_origin},
          {"no_position", counts.no_position},
          {"interpolated", counts.interpolated},
          {"measured", counts.measured},
          {"mean_residual", counts.measured > 0 ? Number(counts.residual) : Json(nullptr)}};
}

/// Reads the whole file once. @throws Error where it has become shorter meanwhile.
C3dDetails ReadC3dDetails(C3dFile* file, Warnings* warnings) {
  const WarningContext context(warnings, file->path());
  C3dDetails details;
  details.labels = C3dPointNames(*file, warnings);
  details.outputs = C3dOutputNames(*file);
  details.analog = ReadC3dAnalog(*file, warnings);
  details.events = ReadC3dEvents(*file, warnings);
  details.plates = ReadC3dForcePlates(file->parameters(), nullptr);
  if (!details.plates.empty()) details.forces = ReadForces(file->path(), warnings);
  details.points = CountC3dPoints(file);
  return details;
}

/// A line for each kind of content, then tables.
std::string FormatC3dDetails(const C3dFile& file, const C3dDetails& details) {
  const LabelCounts labels = CountLabels(details);
  const C3dPointCounts total = Total(details.points);
  const std::string measured =
      total.measured > 0 ? fmt::format("{} of them interpolated or computed", total.interpolated)
                         : "no residual is stated";
  std::string text = fmt::format(
      "stored     {}, {}\npoints     {}: {} labelled, {} unlabelled, {} angles, forces and the "
      "like; {} seen at some time\n"
      "positions  {} seen ({}), {} marked invalid, {} at the "
      "origin, {} without numbers\n",
      ProcessorName(file.layout().processor), file.layout().floats ? "floats" : "integers",
      details.labels.size(), labels.labelled, labels.unlabelled, labels.outputs, labels.seen,
      total.seen, measured, total.marked_invalid, total.at_origin, total.no_position);
  if (total.measured > 0) {
    text += fmt::format("residual   {:.3g} on average, where one is stated\n", total.residual);
  }
  return text + FormatAnalog(details.analog) + FormatPlates(file.layout(), details) +
         FormatEvents(details.events, file.layout()) + FormatParameters(file.parameters());
}

/// Adds the members stored, positions, points, analog, force_plates, events and parameters.
void AddC3dDetails(const C3dFile& file, const C3dDetails& details, Json* json) {
  const LabelCounts labels = CountLabels(details);
  Json points = Json::array();
  for (std::size_t i = 0; i < details.labels.size(); ++i) {
    Json point = {{"label", details.labels[i]}};
    point.update(CountsJson(details.points[i]));
    points.push_back(std::move(point));
  }
  Json events = Json::array();
  for (const C3dEvent& event : details.events) {
    const std::optional<long> frame = FrameAt(event.time, file.layout());
    events.push_back({{"time_s", event.time},
                      {"frame", frame ? Json(*frame) : Json(nullptr)},
                      {"label", event.label},
                      {"context", event.context},
                      {"subject", event.subject},
                      {"in_header", event.is_in_header}});
  }
  const C3dLayout& layout = file.layout();
  (*json)["stored"] = {{"processor", ProcessorName(layout.processor)},
                       {"floats", layout.floats},
                       {"scale", Number(layout.scale, 9)},
                       {"last_frame", layout.first_frame + layout.frames - 1},
                       {"labelled", labels.labelled},
                       {"unlabelled", labels.unlabelled},
                       {"outputs", labels.outputs}};
  (*json)["positions"] = CountsJson(Total(details.points));
  (*json)["points"] = std::move(points);
  (*json)["analog"] = AnalogJson(details.analog);
  (*json)["force_plates"] = PlatesJson(layout, details);
  (*json)["events"] = std::move(events);
  (*json)["parameters"] = ParametersJson(file.parameters());
}

/// What a conversion of a recording, with defaults, would have to go by.
struct Prospect {
  std::string failure;     ///< why it can't be converted like that; empty: it can
  std::string marker_set;  ///< that it would be read with; empty: the configuration's own list
  MarkerMapping mapping;
  std::shared_ptr<const NamedMarkers> names;  ///< by which it would be read; null: by that set
  Person person;
  std::vector<Limb> limbs;
  std::vector<Gap> gaps;            ///< of more than a second
  std::vector<std::string> doubts;  ///< of unit and axis
};

/// Plans the conversion of a recording that was read before, and tracks nothing.
Prospect FindProspect(const InputRequest& request, std::shared_ptr<const Recording> recording) {
  Prospect prospect;
  ConversionRequest conversion;
  conversion.input = request;
  ReadBefore read_before;
  read_before.motion.value = std::move(recording);
  try {
    const ConversionPlan plan = PlanConversion(conversion, read_before);
    prospect.marker_set = plan.setup.marker_set;
    prospect.mapping = plan.setup.mapping;
    prospect.names = plan.input.names;
    prospect.person = plan.person;
    prospect.limbs = LimbsOf(plan.setup);
    for (const ReadingDoubt& doubt : plan.input.recording.doubts) {
      prospect.doubts.push_back(WithAdvice(doubt.text, doubt.remedy));
    }
    prospect.gaps = LongGaps(plan.setup, plan.input.recording.markers);
  } catch (const Error& error) {
    prospect.failure = WithAdvice(error);
  }
  return prospect;
}

// Names of limbs that so many joints' worth of markers show, or of the others.
std::vector<std::string> LimbNames(const Prospect& prospect, bool is_known) {
  std::vector<std::string> names;
  for (const Limb& limb : prospect.limbs) {
    const bool has_enough = limb.IsKnownBy(static_cast<int>(limb.labels.size()));
    if (has_enough == is_known) names.push_back(limb.name);
  }
  return names;
}

std::string NamesOrNone(const std::vector<std::string>& names) {
  return names.empty() ? "none" : FirstNames(names);
}

/// What a conversion would read a recording with, what it could tell and what not, in a few lines.
std::string FormatProspect(const Prospect& prospect) {
  if (!prospect.failure.empty()) return fmt::format("converting fails: {}\n", prospect.failure);
  const MarkerMapping& mapping = prospect.mapping;
  std::string text =
      fmt::format("marker set {}: {} labels used; not known: {}; not there: {}\n",
                  prospect.marker_set.empty() ? "of the configuration" : prospect.marker_set,
                  mapping.assignments.size(), NamesOrNone(mapping.ignored_labels),
                  NamesOrNone(mapping.absent_markers));
  if (prospect.names)
    text += "names      " + DescribeNames(*prospect.names) + FormatNames(*prospect.names);
  if (!prospect.limbs.empty()) {
    text +=
        fmt::format("shown      {}; too few markers: {}\n", NamesOrNone(LimbNames(prospect, true)),
                    NamesOrNone(LimbNames(prospect, false)));
  }
  for (const Gap& gap : prospect.gaps) {
    text +=
        fmt::format("hidden     {}, frames {} to {}\n", gap.what, gap.first_frame, gap.last_frame);
  }
  if (prospect.person.height.value > 0) {
    text += fmt::format("height     {}\n", DescribeHeight(prospect.person));
  }
  for (const std::string& doubt : prospect.doubts) text += fmt::format("doubtful   {}\n", doubt);
  return text;
}

/// The same as JSON.
Json ToJson(const Prospect& prospect) {
  Json gaps = Json::array();
  for (const Gap& gap : prospect.gaps) {
    gaps.push_back(
        {{"what", gap.what}, {"first_frame", gap.first_frame}, {"last_frame", gap.last_frame}});
  }
  const Person& person = prospect.person;
  return {{"failure", TextOrNull(prospect.failure)},
          {"marker_set", TextOrNull(prospect.marker_set)},
          {"markers_used", prospect.mapping.assignments.size()},
          {"ignored", prospect.mapping.ignored_labels},
          {"absent", prospect.mapping.absent_markers},
          {"names", prospect.names ? NamesJson(*prospect.names) : Json(nullptr)},
          {"shown", LimbNames(prospect, true)},
          {"not_shown", LimbNames(prospect, false)},
          {"hidden", gaps},
          {"height_m", person.height.value > 0 ? Number(person.height.value) : Json(nullptr)},
          {"height_deviation_m",
           person.height_deviation > 0 ? Number(person.height_deviation) : Json(nullptr)},
          {"doubts", prospect.doubts}};
}

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
