// SPDX-License-Identifier: MIT
#include "common/io/mmm/mmm_measurements.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <unordered_set>
#include <utility>

#include "common/support/text.h"

namespace mmm_converter {
namespace {

constexpr double kMetresPerMillimetre = 1e-3;
constexpr double kMostNumber = 1e9;  // mm or rad; squares of what a damaged file has overflow

std::string Shown(const std::string& text) {
  constexpr std::size_t kMost = 60;
  return text.size() <= kMost ? text : text.substr(0, kMost) + "...";
}

/// Sees that the times of one sensor increase.
class Clock {
 public:
  explicit Clock(Diagnostics* diagnostics) : diagnostics_(*diagnostics) {}

  /// The time in `text` if it is one that comes after the last; reports what else it is.
  std::optional<double> Next(const std::string& text, int line) {
    const std::optional<double> time = ParseDouble(text);
    if (!time || !std::isfinite(*time)) {
      diagnostics_.AddError(
          line, fmt::format("timestep: found \"{}\", expected a time in seconds", Shown(text)));
      return std::nullopt;
    }
    if (*time < last_) {
      diagnostics_.AddError(
          line, fmt::format("the time {} s comes after {} s; times must increase", *time, last_));
      return std::nullopt;
    }
    if (*time == last_) {
      ++repeats_;
      return std::nullopt;
    }
    last_ = *time;
    return time;
  }

  void WarnOfRepeats(int line) const {
    if (repeats_ == 0) return;
    diagnostics_.AddWarning(
        line, fmt::format("{} measurements repeat the time of the one before and are left out",
                          repeats_));
  }

 private:
  Diagnostics& diagnostics_;
  double last_ = -std::numeric_limits<double>::infinity();
  int repeats_ = 0;
};

/// Calls read(measurement, time) for each measurement that has a new time.
template <typename Read>
void ForEachMeasurement(LongXml& xml, const XmlElement& sensor, Diagnostics* diagnostics,
                        const Read& read) {
  const XmlElement* data = sensor.FindChild("Data");
  if (data == nullptr) return;
  Clock clock(diagnostics);
  xml.ForEachChild(*data, "Measurement", [&](const XmlElement& measurement) {
    const std::string* time_text = measurement.FindAttribute("timestep");
    if (time_text != nullptr) {
      if (const auto time = clock.Next(*time_text, measurement.line)) read(measurement, *time);
    } else if (!measurement.children.empty()) {  // real files have empty ones as placeholders
      diagnostics->AddError(measurement.line, "<Measurement> has no timestep");
    }
  });
  clock.WarnOfRepeats(sensor.line);
}

/// Appends the `count` numbers of an element, times unit. Reports and appends nothing where there
/// are others.
bool AppendNumbers(const XmlElement& element, std::size_t count, double unit,
                   std::vector<double>* values, Diagnostics* diagnostics) {
  const std::size_t size = values->size();
  const bool are_numbers = AppendDoubles(element.text, values);
  const std::size_t found = values->size() - size;
  const bool are_possible =
      std::none_of(values->begin() + static_cast<std::ptrdiff_t>(size), values->end(),
                   [](double number) { return std::abs(number) > kMostNumber; });
  if (are_numbers && found == count && are_possible) {
    for (std::size_t i = size; i < values->size(); ++i) (*values)[i] *= unit;
    return true;
  }
  values->resize(size);
  diagnostics->AddError(
      element.line,
      found == count && !are_possible
          ? fmt::format("<{}>: found \"{}\", expected numbers up to {:g}", element.name,
                        Shown(element.text), kMostNumber)
      : are_numbers ? fmt::format("<{}> has {} numbers, expected {}", element.name, found, count)
                    : fmt::format("<{}>: found \"{}\", expected {} numbers", element.name,
                                  Shown(element.text), count));
  return false;
}

/// The same for the child `name`, which must exist.
bool AppendChild(const XmlElement& parent, const char* name, std::size_t count, double unit,
                 std::vector<double>* values, Diagnostics* diagnostics) {
  const XmlElement* child = parent.FindChild(name);
  if (child != nullptr) return AppendNumbers(*child, count, unit, values, diagnostics);
  diagnostics->AddError(parent.line, fmt::format("<{}> has no <{}>", parent.name, name));
  return false;
}

void AppendPose(const XmlElement& parent, double time, TimedRows* poses, Diagnostics* diagnostics) {
  const std::size_t size = poses->values.size();
  if (AppendChild(parent, "RootPosition", 3, kMetresPerMillimetre, &poses->values, diagnostics) &&
      AppendChild(parent, "RootRotation", 3, 1, &poses->values, diagnostics)) {
    poses->times.push_back(time);
  } else {
    poses->values.resize(size);
  }
}

std::vector<std::string> ReadJointNames(const XmlElement* parent, Diagnostics* diagnostics) {
  std::vector<std::string> names;
  if (parent == nullptr) return names;
  std::unordered_set<std::string> known;
  for (const XmlElement* joint : parent->FindChildren("Joint")) {
    const std::string* name = joint->FindAttribute("name");
    if (name == nullptr || Trim(*name).empty()) {
      diagnostics->AddError(joint->line, "<Joint> has no name");
      continue;
    }
    names.emplace_back(Trim(*name));
    if (!known.insert(names.back()).second) {
      diagnostics->AddError(joint->line, fmt::format("joint {} is listed twice", names.back()));
    }
  }
  return names;
}

int LabelIndex(const std::string& label, MarkerRows* markers) {
  const auto [entry, is_new] =
      markers->label_index.try_emplace(label, static_cast<int>(markers->labels.size()));
  if (is_new) markers->labels.push_back(label);
  return entry->second;
}

void ReadLegacyFrame(const XmlElement& frame, Clock* clock, LegacyFrames* result,
                     Diagnostics* diagnostics) {
  const XmlElement* time_element = frame.FindChild("Timestep");
  if (time_element == nullptr) {
    diagnostics->AddError(frame.line, "<MotionFrame> has no <Timestep>");
    return;
  }
  const auto time = clock->Next(time_element->text, time_element->line);
  if (!time) return;
  if (frame.FindChild("RootPosition") != nullptr || frame.FindChild("RootRotation") != nullptr) {
    AppendPose(frame, *time, &result->poses, diagnostics);
  }
  const std::size_t num_joints = result->joints.names.size();
  TimedRows& joints = result->joints.rows;
  if (num_joints > 0 &&
      AppendChild(frame, "JointPosition", num_joints, 1, &joints.values, diagnostics)) {
    joints.times.push_back(*time);
  }
  const XmlElement* center = frame.FindChild("CoM");
  TimedRows& centers = result->centers_of_mass;
  if (center != nullptr &&
      AppendNumbers(*center, 3, kMetresPerMillimetre, &centers.values, diagnostics)) {
    centers.times.push_back(*time);
  }
}

}  // namespace

TimedRows ReadPoseSensor(LongXml& xml, const XmlElement& sensor, Diagnostics* diagnostics) {
  TimedRows poses;
  poses.width = 6;
  ForEachMeasurement(xml, sensor, diagnostics, [&](const XmlElement& measurement, double time) {
    if (!measurement.children.empty()) AppendPose(measurement, time, &poses, diagnostics);
  });
  return poses;
}

JointRows ReadKinematicSensor(LongXml& xml, const XmlElement& sensor, Diagnostics* diagnostics) {
  JointRows joints;
  joints.names = ReadJointNames(sensor.FindChild("Configuration"), diagnostics);
  joints.rows.width = static_cast<int>(joints.names.size());
  ForEachMeasurement(xml, sensor, diagnostics, [&](const XmlElement& measurement, double time) {
    if (measurement.children.empty()) return;
    if (AppendChild(measurement, "JointPosition", joints.names.size(), 1, &joints.rows.values,
                    diagnostics)) {
      joints.rows.times.push_back(time);
    }
  });
  return joints;
}

void ReadMarkerSensor(LongXml& xml, const XmlElement& sensor, MarkerRows* markers,
                      Diagnostics* diagnostics) {
  std::vector<int> last_seen_in;  // measurement, by label
  std::vector<double> position;
  ForEachMeasurement(xml, sensor, diagnostics, [&](const XmlElement& measurement, double time) {
    const int index = static_cast<int>(markers->times.size());
    markers->times.push_back(time);
    for (const XmlElement& marker : measurement.children) {
      const std::string* name = marker.FindAttribute("name");
      if (!marker.Is("MarkerPosition") || name == nullptr || Trim(*name).empty()) continue;
      position.clear();
      if (!AppendNumbers(marker, 3, kMetresPerMillimetre, &position, diagnostics)) continue;
      const int label = LabelIndex(std::string(Trim(ToUtf8(*name))), markers);
      last_seen_in.resize(markers->labels.size(), -1);
      if (std::exchange(last_seen_in[label], index) == index) {
        diagnostics->AddError(marker.line,
                              fmt::format("marker {} is there twice at {} s", *name, time));
      }
      const Eigen::Vector3d p_WM = Eigen::Vector3d::Map(position.data());
      if (p_WM.allFinite()) markers->sightings.push_back({index, label, p_WM});
    }
  });
}

LegacyFrames ReadLegacyFrames(LongXml& xml, const XmlElement& motion, Diagnostics* diagnostics) {
  LegacyFrames result;
  result.joints.names = ReadJointNames(motion.FindChild("JointOrder"), diagnostics);
  result.joints.rows.width = static_cast<int>(result.joints.names.size());
  result.poses.width = 6;
  result.centers_of_mass.width = 3;
  const XmlElement* frames = motion.FindChild("MotionFrames");
  if (frames == nullptr) return result;
  Clock clock(diagnostics);
  xml.ForEachChild(*frames, "MotionFrame", [&](const XmlElement& frame) {
    if (!frame.children.empty()) ReadLegacyFrame(frame, &clock, &result, diagnostics);
  });
  clock.WarnOfRepeats(frames->line);
  return result;
}

}  // namespace mmm_converter
