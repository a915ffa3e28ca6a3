// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "common/pipeline/conversion.h"
#include "common/retarget/motion_governor.h"

namespace mmm_converter {

constexpr double kDefaultCalibration = 15;   ///< [s]
constexpr double kLongestCalibration = 120;  ///< [s] frames are kept for so long

inline bool IsCalibrationTime(double seconds) {
  return seconds >= 1 && seconds <= kLongestCalibration;
}
inline const char* DescribeCalibrationTime() { return "1 to 120 seconds"; }

/// What the user asked for. input.file: the address of the source; label: points are named by the
/// body, whatever the source calls them; robot: one that follows the person. Empty: a default.
struct LiveRequest : ConversionRequest {
  /// Seconds of moving about that the person is estimated from, where that is asked for; else 0.
  double calibration_time = 0;
  FollowOptions follow;            ///< of the robot
  bool loops = false;              ///< of a replay
  std::vector<std::string> sinks;  ///< addresses that postures are sent to
  bool view = false;               ///< serve the page
  std::string view_address;        ///< "HOST:PORT" to listen on; empty: loopback, any port
  double longest = 0;              ///< ends after so many seconds; 0: never
  bool realtime = false;           ///< ask the system for real-time priority
  int processor = -1;              ///< that the tracking thread stays on; -1: any
};

}  // namespace mmm_converter
