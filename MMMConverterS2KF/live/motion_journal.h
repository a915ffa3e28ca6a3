// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "common/convert/motion_converter.h"
#include "common/io/mmm/mmm_motion.h"
#include "common/live/pose_frame.h"
#include "common/live/pose_sink.h"
#include "common/motion/marker_sequence.h"
#include "common/support/line_file.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// What a motion is written with when its stream has ended, or its process was killed.
struct JournalHeader {
  std::string output;      ///< the motion's file
  std::string format;      ///< "2.0" or "1.0"
  MmmMotionOutput motion;  ///< but for postures and markers
  double rate = 0;         ///< [Hz]; 0: not known
  std::vector<std::string> labels, joints;
};

/// The file that a motion is kept in while it comes: beside it, called as it + ".live". A line a
/// frame (README.md); what is written is safe if the program crashes.
std::string JournalOf(const std::string& output);

/// Writes frames into a journal, at least twice a second.
class MotionJournal : public PoseSink {
 public:
  /// keeps_all: frames before anybody is seen, too, as of a recording. @throws Error as LineFile.
  MotionJournal(const JournalHeader& header, bool keeps_all);

  std::string name() const override { return header_.output; }
  /// Before the first posture frames that show three markers, then all. @throws WriteError
  void Write(const std::shared_ptr<const LiveBody>& body, const PoseFrame& frame) override;
  void End() override;
  bool needs_every_frame() const override { return true; }

 private:
  void Flush();

  JournalHeader header_;
  LineFile file_;
  std::string lines_;
  SteadyTime flushed_;
  bool keeps_all_, has_begun_ = false, is_calibrated_ = false;
};

/// What a journal has, on an even grid of time: frames that did not come have no markers and
/// postures between those around them, those before the first posture take it.
struct JournalContent {
  JournalHeader header;
  MarkerSequence markers;
  ConversionResult result;
  Eigen::MatrixXi verdicts;  ///< assignments x frames
  int first_tracked = 0;     ///< frame
  std::int64_t first_number = 0;
  int frames = 0;  ///< that came
};

/// What can't be read of the last line, where the process was killed in it, is left out. Frames of
/// which most are missing, and which reach further than memory should be taken for, come at a part
/// of their rate, with a warning. @throws Error where it is no journal.
JournalContent ReadJournal(const std::string& file, Warnings* warnings);

/// Writes the motion of a journal that a killed process left, where there is one, beside its output
/// as OUTPUT_recovered.xml. Returns the file written; empty: there was nothing.
/// @throws Error
std::string RecoverMotion(const std::string& output, Warnings* warnings);

}  // namespace mmm_converter
