// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "common/convert/motion_converter.h"
#include "common/live/frame_source.h"

namespace mmm_converter {

/// Whose postures a stream has: new with each person, calibration and layout. Of several bodies
/// each frame has one PoseFrame each, in the order of their indices.
struct LiveBody {
  std::string name;
  TrackingSetup setup;              ///< scaled to the person
  std::vector<std::string> labels;  ///< of PoseFrame::points
  double rate = 0;                  ///< [Hz]; 0: not known
  bool is_calibrated = false;
  int index = 0;  ///< 0: whom the stream is tracked for; else an object that is there too
  int count = 1;  ///< of the bodies of the stream
};

/// One frame of what is known of the body.
struct PoseFrame {
  std::int64_t number = 0;  ///< the source's
  double time = 0;          ///< by the source's clock [s]
  SteadyTime received, tracked;
  bool is_tracking = false;  ///< else the person is waited for, and the estimate says nothing
  bool is_held = false;      ///< the posture is a robot's whose person is not seen
  FrameEstimate estimate;
  Eigen::Matrix3Xd points;   ///< 3 x labels [m], z up; NaN: not seen
  StreamCounts counts;       ///< of the source, until this frame
  const char* stage = "";    ///< what the tracker is at, in words
  double progress = 1;       ///< of gathering frames for a calibration
  std::int64_t dropped = 0;  ///< frames until now that a newer one took the place of
};

}  // namespace mmm_converter
