// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "MMMConverterS2KF/live/motion_journal.h"
#include "common/live/sink_runner.h"
#include "common/pipeline/conversion.h"
#include "common/pipeline/live/live_session.h"
#include "common/pipeline/live_request.h"

namespace mmm_converter {

/// The first motion of each body: OUTPUT, OUTPUT_NAME.xml of other objects.
std::vector<std::string> FirstMotions(const LiveRequest& request);

/// The motions that a run writes: one a body whose labels are its own, each kept in its journal
/// until the end. All but the first are called OUTPUT_2.xml and so on, those of other objects
/// OUTPUT_NAME.xml, OUTPUT_NAME_2.xml.
class LiveOutput {
 public:
  /// @throws Error where an output is a file that is read, two are the same, or one can't be
  /// written.
  explicit LiveOutput(const LiveRequest& request);

  /// The same, of what has been read meanwhile.
  void CheckFiles() const { CheckFiles(nullptr); }

  /// The journal for this plan, where the body is a new one.
  std::unique_ptr<PoseSink> Begin(const ConversionPlan& plan, const LiveBody& body);

  /// Writes all motions, body by body, the first with the request's exports; then the journals are
  /// removed. Those of a robot are written without exports and reports.
  /// @throws Error; journals that were not written stay.
  std::vector<ConversionReport> Finish(const std::optional<CalibrationResult>& calibration);

  const std::vector<std::string>& robot_motions() const { return robot_motions_; }

  /// Of the motion of a body that is being written: its plan has changed.
  void Update(const ConversionPlan& plan, int body);

 private:
  void CheckFiles(const ConversionPlan* plan) const;
  struct Motion {
    ConversionPlan plan;
    int body = 0;
    int number = 0;  // of this body's motions
    std::string file;
    bool is_first() const { return body == 0 && number == 0; }
  };
  ConversionRequest RequestOf(const Motion& motion) const;
  std::string FileOf(const Motion& motion) const;
  bool IsRobots(const Motion& motion) const {
    return motion.body == 0 && !request_.robot.file.empty();
  }
  void WriteRobotMotion(const Motion& motion, const JournalContent& content);

  LiveRequest request_;
  std::vector<std::string> robot_motions_;
  std::vector<Motion> motions_;
};

}  // namespace mmm_converter
