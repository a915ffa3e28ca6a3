// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <deque>
#include <functional>
#include <utility>

#include "common/convert/motion_converter.h"
#include "common/convert/tracking_setup.h"
#include "common/motion/marker_sequence.h"

namespace mmm_converter {

/// How many assigned markers a frame shows.
int CountSeen(const Eigen::Ref<const Eigen::Matrix3Xd>& frame, const TrackingSetup& setup);

/// In which frame tracking begins: the first that shows a third of the assigned markers, or, a
/// second after the first three are seen, one that shows as many as any of the second before it.
/// Who comes late is there in part at first. Looks at nothing that comes later, so that a stream
/// begins where its recording does.
class TrackingStart {
 public:
  explicit TrackingStart(const TrackingSetup& setup);

  /// Of the next frame: its time [s] and what CountSeen says.
  bool IsAt(double time, int seen);

 private:
  int enough_;
  double since_ = 0;  // three are seen [s]
  // Time and number seen of frames of the last second, of those that later ones do not exceed.
  std::deque<std::pair<double, int>> most_;
};

/// Assembles the frame `first` anew and tracks backward from there while three markers are where
/// the posture has them, at most to the frame `earliest`. write(k, estimate, seconds) gets each
/// frame before the first. Returns the last one, or `first`.
int TrackBackward(const MarkerSequence& recording, int first, int earliest,
                  MotionConverter* converter,
                  const std::function<void(int, const FrameEstimate&, double seconds)>& write);

/// Fills frames of a result from what a converter says of them. All that it is given must outlive
/// it.
class ResultWriter {
 public:
  /// verdicts: assignments x frames, those of MarkerIncident.
  ResultWriter(const MarkerSequence& recording, const TrackingSetup& setup,
               Eigen::MatrixXi* verdicts, ConversionResult* result);

  /// Nothing is known of any frame yet.
  void Clear();
  void Write(int k, const FrameEstimate& estimate, double seconds);
  /// Frames before the body is there take its first posture, which is not theirs.
  void WriteEarlier(int first);
  void FindIncidents();

 private:
  const MarkerSequence& recording_;
  const TrackingSetup& setup_;
  Eigen::MatrixXi& verdicts_;
  ConversionResult& result_;
};

}  // namespace mmm_converter
