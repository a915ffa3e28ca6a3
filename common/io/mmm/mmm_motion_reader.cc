// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <deque>
#include <iterator>
#include <limits>
#include <numeric>
#include <optional>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "common/io/mmm/mmm_motion.h"
#include "common/io/mmm/motion_timeline.h"
#include "common/io/xml/long_xml.h"
#include "common/io/xml/xml_text.h"
#include "common/math/rotation.h"
#include "common/support/diagnostics.h"
#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

/// Elements that a motion may have millions of.
inline constexpr const char* kManyElements[] = {"Measurement", "MotionFrame"};

/// Values of joints over time [rad].
struct JointRows {
  std::vector<std::string> names;
  TimedRows rows;
};

/// Markers as a file has them: which measurement saw which label where.
struct MarkerRows {
  struct Sighting {
    int measurement;  ///< in times
    int label;
    Eigen::Vector3d p_WM;  ///< [m]
  };
  std::vector<std::string> labels;
  std::unordered_map<std::string, int> label_index;
  std::vector<double> times;       ///< of every measurement, those without markers too; not sorted
  std::deque<Sighting> sightings;  ///< there may be millions: it grows without a copy
};

// Each reads one 2.0 <Sensor> of `xml`, which leaves out kManyElements, and reports what is wrong.
// Times increase in the result; a measurement that repeats the time of the one before is left out,
// with a warning. Millimetres become metres.

/// The frames of a 1.0 motion; poses and centers [m] are empty where the frames have none.
struct LegacyFrames {
  TimedRows poses;
  JointRows joints;
  TimedRows centers_of_mass;
};

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

/// Rows of [root position 3 [m], roll pitch yaw [rad]].
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

/// Adds to `markers`, so that several sensors become one; markers without name and such at NaN are
/// left out.
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

constexpr double kMetresPerCentimetre = 1e-2;
constexpr std::size_t kMostMotions = 10000;  // of a file; real ones have up to some dozens

/// Numbers that the motions of a file may take in memory: several times what its text can hold, as
/// a number takes six characters and more, so that gaps and rare markers have room, and a few bytes
/// can't ask for gigabytes.
class Budget {
 public:
  Budget(std::size_t content_bytes, Diagnostics* diagnostics)
      : left_(2e6 + 1.0 * static_cast<double>(content_bytes)), diagnostics_(*diagnostics) {}

  /// True, or an error, if each frame takes so many numbers.
  bool Take(const TimeGrid& grid, std::size_t numbers_per_frame, int line) {
    const auto frames = static_cast<double>(grid.num_frames());
    const double numbers =
        frames * static_cast<double>(std::max<std::size_t>(numbers_per_frame, 1));
    if (numbers <= left_ && frames <= std::numeric_limits<int>::max()) {
      left_ -= numbers;
      return true;
    }
    diagnostics_.AddError(
        line,
        fmt::format("{} measurements from {} s on span {:.6g} frames at {:.6g} Hz, more than "
                    "such a file can need; are its timesteps in seconds and free of outliers?",
                    grid.frames.size(), grid.first_time, frames, grid.rate));
    return false;
  }

 private:
  double left_;
  Diagnostics& diagnostics_;
};

void CheckRate(const TimeGrid& grid, int line, Diagnostics* diagnostics) {
  if (IsFrameRate(grid.rate)) return;
  diagnostics->AddError(
      line, fmt::format("timesteps from {} s on are {:.6g} s apart, which is {:.6g} Hz and outside "
                        "{:.0f} to {:.0f} Hz; are they in seconds?",
                        grid.first_time, 1 / grid.rate, grid.rate, kLowestRate, kHighestRate));
}

void WarnIfUneven(const TimeGrid& grid, int line, Diagnostics* diagnostics) {
  if (grid.even) return;
  diagnostics->AddWarning(
      line, fmt::format("timesteps are uneven; frames are taken as {:.6g} s apart", 1 / grid.rate));
}

std::optional<double> ReadPositive(const XmlElement& parent, const char* name, double unit,
                                   Diagnostics* diagnostics) {
  const XmlElement* element = parent.FindChild(name);
  if (element == nullptr) return std::nullopt;
  const std::optional<double> number = ParseDouble(element->text);
  if (number && *number > 0 && std::isfinite(*number)) return *number * unit;
  diagnostics->AddError(element->line, fmt::format("<{}>: found \"{}\", expected a positive number",
                                                   name, element->text));
  return std::nullopt;
}

void ReadModel(const XmlElement& element, MmmMotion* motion, Diagnostics* diagnostics) {
  const XmlElement* config = element.FindChild("ModelProcessorConfig");
  if (const XmlElement* model = element.FindChild("Model")) {
    if (const std::string* path = model->FindAttribute("path")) motion->model_path = *path;
    if (const XmlElement* path = model->FindChild("File")) motion->model_path = path->text;
    if (const XmlElement* inner = model->FindChild("ModelProcessorConfig")) config = inner;
  }
  if (config == nullptr) return;
  motion->size.height = ReadPositive(*config, "Height", 1, diagnostics);
  motion->size.mass = ReadPositive(*config, "Mass", 1, diagnostics);
  motion->size.hand_length = ReadPositive(*config, "HandLength", kMetresPerCentimetre, diagnostics);
}

/// Sets position and orientation at every frame time; between poses the shorter way is turned.
void FillRoot(const TimedRows& poses, const std::vector<double>& frame_times, double hold,
              PoseTrajectory* trajectory) {
  const Eigen::MatrixXd values = Resample(poses, frame_times, hold);
  std::size_t next = 0;  // the first pose at or after the frame
  for (std::size_t k = 0; k < frame_times.size(); ++k) {
    while (next < poses.times.size() && poses.times[next] < frame_times[k]) ++next;
    Posture& posture = trajectory->postures[k];
    posture.position = values.col(static_cast<Eigen::Index>(k)).head<3>();
    const auto rotation = [&](std::size_t i) {
      return Eigen::Quaterniond(RotationFromRpy(Eigen::Vector3d::Map(poses.row(i) + 3)));
    };
    if (next == poses.times.size() || poses.times[next] == frame_times[k]) {
      posture.orientation = rotation(std::min(next, poses.times.size() - 1));
    } else {
      const double before = poses.times[next - 1];
      const double share = (frame_times[k] - before) / (poses.times[next] - before);
      posture.orientation = rotation(next - 1).slerp(share, rotation(next));
    }
  }
}

/// Appends the joints that no earlier sensor has.
void AddJoints(const JointRows& joints, const std::vector<double>& frame_times, double hold,
               int line, std::unordered_set<std::string>* known, PoseTrajectory* trajectory,
               Diagnostics* diagnostics) {
  const Eigen::MatrixXd values = Resample(joints.rows, frame_times, hold);
  std::vector<int> added;
  for (int i = 0; i < values.rows(); ++i) {
    if (known->insert(joints.names[i]).second) {
      added.push_back(i);
      trajectory->joint_names.push_back(joints.names[i]);
    } else {
      diagnostics->AddWarning(line,
                              fmt::format("joint {} is in two Kinematic sensors; the first "
                                          "one counts",
                                          joints.names[i]),
                              "joints that are in two Kinematic sensors");
    }
  }
  for (std::size_t k = 0; k < frame_times.size(); ++k) {
    Eigen::VectorXd& angles = trajectory->postures[k].joint_angles;
    const Eigen::Index old_size = angles.size();
    angles.conservativeResize(old_size + static_cast<Eigen::Index>(added.size()));
    angles.tail(angles.size() - old_size) = values(added, static_cast<Eigen::Index>(k));
  }
  if (!values.allFinite()) {
    diagnostics->AddWarning(
        line, "the trajectory has joint angles that are NaN, or outside of their sensor's time",
        "sensors whose joint angles are NaN, or outside of their time");
  }
}

void BuildTrajectory(const TimedRows& poses, const std::vector<JointRows>& joints,
                     const TimedRows& centers_of_mass, int line, MmmMotion* motion, Budget* budget,
                     Diagnostics* diagnostics) {
  const TimedRows* base = &poses;
  std::size_t num_joints = 0;
  for (const JointRows& sensor : joints) {
    if (base->times.empty()) base = &sensor.rows;
    num_joints += sensor.names.size();
  }
  if (base->times.empty()) return;
  const TimeGrid grid = FitTimeGrid(base->times);
  if (!budget->Take(grid, 7 + num_joints, line)) return;
  CheckRate(grid, line, diagnostics);
  WarnIfUneven(grid, line, diagnostics);

  PoseTrajectory& trajectory = motion->trajectory;
  trajectory.rate = grid.rate;
  trajectory.first_time = grid.first_time;
  trajectory.postures.resize(static_cast<std::size_t>(grid.num_frames()));
  const std::vector<double> frame_times = FrameTimes(grid, base->times);
  const double hold = 0.501 / grid.rate;  // half a step and rounding
  if (poses.times.empty()) {
    diagnostics->AddWarning(line, "there are joint angles but no ModelPose; the root stays at 0");
  } else {
    FillRoot(poses, frame_times, hold, &trajectory);
  }
  std::unordered_set<std::string> known;
  for (const JointRows& sensor : joints) {
    if (sensor.rows.times.empty()) continue;
    AddJoints(sensor, frame_times, hold, line, &known, &trajectory, diagnostics);
  }
  if (!centers_of_mass.times.empty()) {
    motion->center_of_mass = Resample(centers_of_mass, frame_times, hold);
  }
}

void BuildMarkers(const MarkerRows& rows, int line, MmmMotion* motion, Budget* budget,
                  Diagnostics* diagnostics) {
  if (rows.labels.empty()) return;
  std::vector<double> times = rows.times;
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  const TimeGrid grid = FitTimeGrid(times);
  if (!budget->Take(grid, 3 * rows.labels.size(), line)) return;
  CheckRate(grid, line, diagnostics);
  WarnIfUneven(grid, line, diagnostics);
  std::vector<int> order(rows.labels.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return rows.labels[a] < rows.labels[b]; });
  std::vector<std::string> labels;
  std::vector<int> place(order.size());
  for (const int label : order) {
    place[label] = static_cast<int>(labels.size());
    labels.push_back(rows.labels[label]);
  }
  motion->markers = MarkerSequence(std::move(labels), static_cast<int>(grid.num_frames()),
                                   grid.rate, grid.first_time);
  std::vector<int> frame_of;  // each measurement
  for (const double time : rows.times) {
    const auto i = std::lower_bound(times.begin(), times.end(), time) - times.begin();
    frame_of.push_back(static_cast<int>(grid.frames[i]));
  }
  for (const MarkerRows::Sighting& sighting : rows.sightings) {
    auto p_WM = motion->markers.frame(frame_of[sighting.measurement]).col(place[sighting.label]);
    if (!IsSeen(p_WM)) p_WM = sighting.p_WM;
  }
}

void ReadSensors(LongXml& xml, const XmlElement& sensors, MmmMotion* motion, Budget* budget,
                 Diagnostics* diagnostics) {
  TimedRows poses;
  std::vector<JointRows> joints;
  MarkerRows markers;
  for (const XmlElement* sensor : sensors.FindChildren("Sensor")) {
    const std::string* type = sensor->FindAttribute("type");
    if (type == nullptr) {
      diagnostics->AddError(sensor->line, "<Sensor> has no type");
    } else if (EqualIgnoringCase(*type, "ModelPose")) {
      TimedRows found = ReadPoseSensor(xml, *sensor, diagnostics);
      if (poses.times.empty()) {
        poses = std::move(found);
      } else {
        diagnostics->AddWarning(sensor->line, "a second ModelPose sensor is not used",
                                "ModelPose sensors that are not used");
      }
    } else if (EqualIgnoringCase(*type, "Kinematic")) {
      joints.push_back(ReadKinematicSensor(xml, *sensor, diagnostics));
    } else if (EqualIgnoringCase(*type, "MoCapMarker")) {
      ReadMarkerSensor(xml, *sensor, &markers, diagnostics);
    }
  }
  BuildTrajectory(poses, joints, {}, sensors.line, motion, budget, diagnostics);
  BuildMarkers(markers, sensors.line, motion, budget, diagnostics);
}

MmmMotion ReadMotion(LongXml& xml, const XmlElement& element, Budget* budget,
                     Diagnostics* diagnostics) {
  MmmMotion motion;
  if (const std::string* name = element.FindAttribute("name")) motion.name = *name;
  if (const std::string* type = element.FindAttribute("type")) motion.type = *type;
  ReadModel(element, &motion, diagnostics);
  if (const XmlElement* sensors = element.FindChild("Sensors")) {
    ReadSensors(xml, *sensors, &motion, budget, diagnostics);
  }
  if (const XmlElement* frames = element.FindChild("MotionFrames")) {
    const LegacyFrames legacy = ReadLegacyFrames(xml, element, diagnostics);
    BuildTrajectory(legacy.poses, {legacy.joints}, legacy.centers_of_mass, frames->line, &motion,
                    budget, diagnostics);
  }
  return motion;
}

MmmMotionFile ReadMotions(const ByteSource& content, const std::string& file, Warnings* warnings) {
  constexpr int kHighestLevel = 3;  // MMM / Motion / MotionFrames / MotionFrame
  LongXml xml(content, file, {std::begin(kManyElements), std::end(kManyElements)}, kHighestLevel);
  const XmlElement& root = xml.root();
  Diagnostics diagnostics(file, warnings);
  if (!root.Is("MMM")) {
    diagnostics.AddError(root.line,
                         fmt::format("the root is <{}>; an MMM motion has <MMM>{}", root.name,
                                     root.Is("Robot") ? " (this is a model)" : ""));
    diagnostics.ThrowIfErrors();
  }
  MmmMotionFile result;
  result.version = "1.0";
  if (const std::string* name = root.FindAttribute("name")) result.name = *name;
  if (const std::string* version = root.FindAttribute("version")) {
    if (version->starts_with('2')) result.version = "2.0";
  }
  const std::vector<const XmlElement*> motions = root.FindChildren("Motion");
  if (motions.size() > kMostMotions) {
    throw Error(fmt::format("{}: has {} motions, more than the {} that are read", file,
                            motions.size(), kMostMotions));
  }
  Budget budget(content.size, &diagnostics);
  result.motions.reserve(motions.size());
  for (const XmlElement* element : motions) {
    if (element->FindChild("Sensors") != nullptr) result.version = "2.0";
    result.motions.push_back(ReadMotion(xml, *element, &budget, &diagnostics));
  }
  xml.CheckTheRest();
  if (result.motions.empty()) diagnostics.AddError(root.line, "there is no <Motion>");
  diagnostics.ThrowIfErrors();
  return result;
}

}  // namespace

const MmmMotion* MmmMotionFile::Find(std::string_view motion_name) const {
  const auto found = std::find_if(motions.begin(), motions.end(),
                                  [&](const MmmMotion& m) { return m.name == motion_name; });
  return found == motions.end() ? nullptr : &*found;
}

bool LooksLikeMmmMotion(std::string_view content) {
  return EqualIgnoringCase(RootName(content), "MMM");
}

MmmMotionFile ParseMmmMotionFile(std::string_view content, const std::string& file,
                                 Warnings* warnings) {
  return ReadMotions(BytesOf(content), file, warnings);
}

MmmMotionFile ReadMmmMotionFile(const std::string& path, Warnings* warnings,
                                std::size_t max_bytes) {
  return ReadMotions(BytesOfFile(path, max_bytes), path, warnings);
}

}  // namespace mmm_converter
