// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "common/io/c3d/c3d_file.h"
#include "common/motion/marker_sequence.h"
#include "common/motion/recording_content.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// What a C3D file says of itself.
struct C3dInfo {
  C3dLayout layout;
  std::string unit;                  ///< POINT:UNITS as it stands; may be empty
  std::vector<std::string> labels;   ///< one for each point, with prefixes; no two equal
  std::vector<std::string> outputs;  ///< labels that the file lists as angles, forces, powers, ...
  std::vector<std::string> label_prefixes;  ///< SUBJECTS:LABEL_PREFIXES
  std::string comment;                      ///< MANUFACTURER:COMMENT
  RecordingOrigin origin;  ///< SUBJECTS:NAMES, TRIAL:DATE, MANUFACTURER:COMPANY and SOFTWARE
  std::string up;  ///< POINT:Y_SCREEN, the axis that points up on a screen, as "+Z"; may be empty
  BodySize stated_size;  ///< of the person
};

/// A point of a frame as it is stored.
struct C3dPoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< file unit, scaled
  bool valid = false;    ///< finite and not marked invalid; (0,0,0) counts as valid here
  double residual = -1;  ///< file unit; -1: not valid, NaN: not known
  int cameras = 0;       ///< bit mask
};

/// Reads C3D files of any processor, with integers or floats. Repairs what can be repaired and says
/// so in the warnings. Memory: parameters, the result and one buffer.
class C3dReader {
 public:
  /// @throws Error (not a C3D file, cut in header or parameters, no point, no whole frame).
  explicit C3dReader(const std::string& path, Warnings* warnings = nullptr);

  const C3dInfo& info() const { return info_; }

  /// The chosen points (indices into info().labels) under new labels, in file units. A point that
  /// is marked invalid, not finite, exactly (0,0,0) or further than 1e6 from the origin is NaN.
  /// rate [Hz] > 0; ignore_residuals: takes no notice of the invalid mark.
  MarkerSequence ReadPoints(const std::vector<int>& points, const std::vector<std::string>& labels,
                            double rate, bool ignore_residuals = false);

  std::vector<C3dPoint> ReadFrame(int frame);  ///< all points of one frame

 private:
  C3dFile file_;
  C3dInfo info_;
};

}  // namespace mmm_converter
