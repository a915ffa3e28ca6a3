// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "common/io/mmm/mmm_motion.h"
#include "common/io/robot/robot_exports.h"
#include "common/pipeline/conversion.h"
#include "common/pipeline/dynamics/retarget_objects.h"
#include "common/pipeline/retarget_verdict.h"
#include "common/pipeline/robot.h"
#include "common/retarget/retarget_figures.h"
#include "common/support/output_plan.h"

namespace mmm_converter {

/// What the user asked for. Empty: a default.
struct RetargetRequest {
  /// The recording, which is converted first, or the finished motion; output is the robot's. No
  /// file and nothing below: MakeRaisedKnee of the shipped model, which shows the map.
  ConversionRequest conversion;
  /// What was read or converted already, instead of the file, which names it.
  std::optional<MmmMotion> motion = {};
  const ConversionReport* converted = nullptr;
};

/// The motion at the rate of files that are written, which is not the recording's: a fit of its
/// own.
struct RateFit {
  double rate = 0;  ///< [Hz]
  Retargeted retargeted;
  RetargetFigures figures;
  Verdict verdict;
  std::vector<std::string> files = {};
};

struct RetargetReport {
  std::string file, motion_name;
  std::string robot_file, output;
  Robot robot;
  RobotBody body;
  std::vector<RecordedObject> objects;
  Retargeted retargeted;
  RetargetFigures figures;
  Verdict verdict;                            ///< the worst of what is written
  std::optional<Verdict> conversion_verdict;  ///< of a recording
  Warnings warnings;
  std::string unshown = {};               ///< of the person, in words; empty: nothing
  std::vector<std::string> written = {};  ///< files
  std::shared_ptr<const KinematicModel> person_model = nullptr;
  PoseTrajectory person = {};         ///< as many frames as the robot's
  std::set<std::string> opened = {};  ///< files; see OpenedFiles
  std::vector<RateFit> fits = {};     ///< at other rates
};

/// Says in the plan which files the request names.
void NameInputs(const RetargetRequest& request, OutputPlan* plan);

/// Reads all, converts where that is to be done, and brings the motion to the robot; writes
/// nothing. progress(done, all): frames of a conversion; may be empty.
/// @throws Error
RetargetReport RunRetargeting(const RetargetRequest& request,
                              const std::function<bool(int, int)>& progress);

/// The request for what was converted.
RetargetRequest RequestFor(const ConversionRequest& conversion, const ConversionReport& converted);

/// @throws Error where the format can't hold the robot's motion, before anything is written.
void CheckRobotExport(const RobotExporter& format, const RobotRequest& robot,
                      const RetargetReport& report);

/// Writes `file`, as the conversion's request says of the robot, from a fit at the file's rate.
/// @throws Error
void WriteRobotExport(const RobotExporter& format, const std::string& file,
                      const RobotRequest& robot, RetargetReport* report);

void ExportRobotMotion(const RobotExporter& format, const std::string& file,
                       const RobotExportOptions& options, RetargetReport* report);

/// An MMM motion with the robot's model. @throws Error; the file is then as it was before.
void WriteRobotMotion(RetargetReport* report);

}  // namespace mmm_converter
