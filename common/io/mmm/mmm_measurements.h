// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <deque>
#include <string>
#include <unordered_map>
#include <vector>

#include "common/io/mmm/motion_timeline.h"
#include "common/io/xml/long_xml.h"
#include "common/support/diagnostics.h"

namespace mmm_converter {

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

/// Rows of [root position 3 [m], roll pitch yaw [rad]].
TimedRows ReadPoseSensor(LongXml& xml, const XmlElement& sensor, Diagnostics* diagnostics);
JointRows ReadKinematicSensor(LongXml& xml, const XmlElement& sensor, Diagnostics* diagnostics);
/// Adds to `markers`, so that several sensors become one; markers without name and such at NaN are
/// left out.
void ReadMarkerSensor(LongXml& xml, const XmlElement& sensor, MarkerRows* markers,
                      Diagnostics* diagnostics);

/// The frames of a 1.0 motion; poses and centers [m] are empty where the frames have none.
struct LegacyFrames {
  TimedRows poses;
  JointRows joints;
  TimedRows centers_of_mass;
};
LegacyFrames ReadLegacyFrames(LongXml& xml, const XmlElement& motion, Diagnostics* diagnostics);

}  // namespace mmm_converter
