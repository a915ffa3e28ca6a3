// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/report/c3d_details.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "common/support/text.h"

namespace mmm_converter {
namespace {

/// Of values that are listed; the section of a real file has 130 kB at most, that of a hostile one
/// can have tens of millions of numbers.
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

/// Of a sample, counted as markers' frames are from the beginning of the capture [s].
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

}  // namespace

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

}  // namespace mmm_converter
