// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/convert/motion_converter.h"
#include "common/motion/marker_sequence.h"
#include "plugins/s2kf/tracked_markers.h"

namespace mmm_converter::s2kf {

/// Markers that are for a while elsewhere than the person wears them, by the whole recording: a
/// marker's residual, in the axes of its link, is compared with what it is in the other frames of
/// this recording. That tells a marker that wanders by some centimetres, which no single frame does
/// where the person is not known. Find, track Without them, and so on until nothing is found; then
/// Tell.
class MisplacedMarkers {
 public:
  /// Both must outlive the object.
  MisplacedMarkers(const MarkerSequence& recording, const TrackedMarkers& markers);

  /// Adds those that a tracking without the ones found so far shows: each that is then far clearer
  /// than any other, as a wrong posture moves many, and farther off than it ever is else, as one
  /// that moves with the posture comes back. False: there are none.
  bool Find(const ConversionResult& result);

  /// The recording without them.
  MarkerSequence Without() const;

  /// Says of the result of that what became of them: residuals, counts and incidents.
  void Tell(ConversionResult* result) const;

 private:
  /// Frames [begin, end) in which a marker is elsewhere.
  struct Stay {
    int marker;
    int begin;
    int end;
    float farthest;  // over what is allowed
  };

  /// Distances from the middle of each marker's residuals, over what is allowed, markers x frames;
  /// NaN: not seen, or not judged.
  Eigen::MatrixXf Excesses(const ConversionResult& result) const;
  static std::vector<Stay> FindStays(const Eigen::MatrixXf& excesses);

  const MarkerSequence& recording_;
  const TrackedMarkers& markers_;
  Eigen::MatrixXi verdicts_;  // markers x frames: kAsLabelled, or its own index: misplaced
};

}  // namespace mmm_converter::s2kf
