// SPDX-License-Identifier: MIT
#include "common/pipeline/dynamics/retarget_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "common/io/model_file.h"
#include "common/io/recording/recording_formats.h"
#include "common/math/statistics.h"
#include "common/model/model_scaling.h"
#include "common/model/posture.h"
#include "common/motion/marker_residuals.h"
#include "common/motion/resampled.h"
#include "common/motion/synthetic_motion.h"
#include "common/pipeline/dynamics/checked_motion.h"
#include "common/pipeline/ground_study.h"
#include "common/study/coverage.h"
#include "common/support/atomic_file.h"
#include "common/support/opened_files.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

namespace fs = std::filesystem;

bool IsFinishedMotion(const std::string& file) {
  const RecordingFormat* format = FindFormatOfContent(file);
  if (format == nullptr || !format->holds_motions) return false;
  const MmmMotionFile content = ReadMmmMotionFile(file);
  return std::any_of(content.motions.begin(), content.motions.end(), [](const MmmMotion& motion) {
    return motion.trajectory.num_frames() > 0 && !motion.trajectory.joint_names.empty();
  });
}

PoseTrajectory FramesOf(const PoseTrajectory& all, int begin, int end) {
  PoseTrajectory part;
  part.rate = all.rate;
  part.first_time = all.time(begin);
  part.joint_names = all.joint_names;
  part.postures = {all.postures.begin() + begin, all.postures.begin() + end};
  return part;
}

/// Without the frames before the person is seen, whose postures are that of the first one.
PoseTrajectory TrackedFrames(const ConversionReport& report, Warnings* warnings) {
  const PoseTrajectory& all = report.result.trajectory;
  const int before = FramesBeforeFirstSeen(report.result.residuals);
  if (before > 0 && before < all.num_frames()) {
    warnings->Add(fmt::format("the robot's motion begins where the person is seen, at {:.2f} s",
                              all.time(before)));
    return FramesOf(all, before, all.num_frames());
  }
  return all;
}

/// Joints that the markers don't tell rest: what errors of a few millimetres make of them would be
/// a motion that nobody made.
void RestUntoldJoints(const KinematicModel& model, const Eigen::MatrixXd& deviations,
                      PoseTrajectory* motion, Warnings* warnings) {
  constexpr double kTold = 45 / kDegrees, kUntold = 65 / kDegrees;
  constexpr double kBest = 25;  // [%] of the frames: a limb that is hidden for long is told
  if (model.coordinates() || deviations.cols() == 0) return;
  const Posture rest = ZeroPosture(model);
  std::vector<std::string> untold;
  for (std::size_t i = 0; i < motion->joint_names.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const Eigen::VectorXd of_joint = deviations.row(6 + row);
    const double deviation =
        Percentile({of_joint.data(), static_cast<std::size_t>(of_joint.size())}, kBest);
    const double part = std::clamp((deviation - kTold) / (kUntold - kTold), 0.0, 1.0);
    if (!(part > 0)) continue;  // not of a converter that does not know them
    const double angle = rest.joint_angles[model.FindJoint(motion->joint_names[i])];
    for (Posture& posture : motion->postures) {
      posture.joint_angles[row] += part * (angle - posture.joint_angles[row]);
    }
    untold.push_back(motion->joint_names[i]);
  }
  if (untold.empty()) return;
  warnings->Add(
      fmt::format("the markers don't tell {} (standard deviations above {:.0f} degrees): "
                  "they are drawn to where a standing person has them",
                  fmt::join(untold, ", "), kTold * kDegrees));
}

/// contacts: null: by the motion alone.
void RetargetPerson(std::shared_ptr<const KinematicModel> model, PoseTrajectory motion,
                    const FootContacts* contacts, RetargetReport* report, Warnings* warnings) {
  report->retargeted =
      RetargetMotion(*model, motion, report->robot, report->body,
                     AlignObjects(motion, report->objects, warnings), {nullptr, contacts});
  report->person_model = std::move(model);
  report->person = std::move(motion);
}

void RetargetConversion(const ConversionReport& converted, RetargetReport* report,
                        Warnings* warnings) {
  warnings->Append(converted.warnings);
  report->motion_name = converted.plan.motion_name;
  report->conversion_verdict = converted.verdict;
  report->unshown = DescribeUnshown(converted.plan.setup);
  PoseTrajectory motion = TrackedFrames(converted, warnings);
  const Eigen::MatrixXd& all = converted.result.trajectory.standard_deviations;
  const Eigen::Index seen = std::min<Eigen::Index>(all.cols(), motion.num_frames());
  RestUntoldJoints(*converted.plan.setup.model, all.rightCols(seen), &motion, warnings);
  const auto& model = converted.plan.setup.model;
  const auto ground = HasFeet(*model) ? StudyGround(converted) : nullptr;
  RetargetPerson(model, std::move(motion), ground ? &ground->steps : nullptr, report, warnings);
}

void RetargetFinished(CheckedMotion checked, RetargetReport* report, Warnings* warnings) {
  warnings->Append(checked.warnings);
  report->motion_name = checked.name;
  RetargetPerson(std::make_shared<const KinematicModel>(std::move(checked.model)),
                 FramesOf(checked.trajectory, checked.begin, checked.end), nullptr, report,
                 warnings);
}

void RetargetRaisedKnee(RetargetReport* report, Warnings* warnings) {
  constexpr WinterScaling kPerson = {1.75, 70, {}};
  const LoadedModel reference = ReadModelFile(ModelFile(InputRequest{}), warnings);
  auto model = std::make_shared<const KinematicModel>(ScaleWinter(reference.model, kPerson));
  PoseTrajectory motion = MakeRaisedKnee(*model);
  report->motion_name = "a raised knee";
  RetargetPerson(std::move(model), std::move(motion), nullptr, report, warnings);
}

bool HasMotion(const RetargetRequest& request) {
  return !request.conversion.input.file.empty() || request.motion || request.converted != nullptr ||
         request.conversion.input.recording.value != nullptr;
}

std::string DefaultOutput(const std::string& input) {
  const fs::path file = input;
  return (file.parent_path() / (file.stem().string() + "_robot.xml")).string();
}

RobotExportOptions ExportOptionsOf(const RobotRequest& robot, const RetargetReport& report) {
  RobotExportOptions options;
  options.rate = robot.export_rate;
  options.motion_name = report.motion_name;
  if (!robot.order.empty()) options.order = ParseRobotOrder(robot.order);
  return options;
}

PoseTrajectory AtRate(const PoseTrajectory& motion, double rate) {
  JointBounds none;
  none.upper.setConstant(static_cast<Eigen::Index>(motion.joint_names.size()), INFINITY);
  none.lower = -none.upper;
  none.velocity = none.upper;
  return Resample(motion, rate, none);
}

/// Null: the motion's own rate.
RateFit* FitAt(double rate, RetargetReport* report) {
  constexpr double kSameRate = 1e-6;  // of it
  const double own = report->retargeted.motion.rate;
  if (std::abs(rate - own) < kSameRate * own) return nullptr;
  for (RateFit& fit : report->fits) {
    if (fit.rate == rate) return &fit;
  }
  const PoseTrajectory motion = AtRate(report->person, rate);
  Warnings told_before;
  RateFit fit;
  fit.rate = rate;
  fit.retargeted = RetargetMotion(*report->person_model, motion, report->robot, report->body,
                                  AlignObjects(motion, report->objects, &told_before),
                                  {&report->person, &report->retargeted.contacts});
  fit.figures = MeasureRetargeting(fit.retargeted, report->robot, report->body);
  fit.verdict = JudgeRetargeting(
      fit.figures, report->conversion_verdict ? &*report->conversion_verdict : nullptr);
  report->fits.push_back(std::move(fit));
  return &report->fits.back();
}

void TakeWorse(const std::string& file, const RateFit& fit, Verdict* verdict) {
  if (fit.verdict.level <= verdict->level) return;
  *verdict = fit.verdict;
  const std::string name = fs::path(file).filename().string();
  for (std::string& reason : verdict->reasons) {
    reason = fmt::format("{} ({:g} Hz): {}", name, fit.rate, reason);
  }
}

void CheckFiles(const RetargetRequest& request, const std::string& output) {
  OutputPlan plan;
  NameInputs(request, &plan);
  plan.Write(output);
  for (const std::string& file : request.conversion.more_outputs) plan.Write(file);
  plan.Check();
}

}  // namespace

void NameInputs(const RetargetRequest& request, OutputPlan* plan) {
  NameInputs(request.conversion.input, plan);
  plan->Read(request.conversion.robot.file);
  plan->Read(request.conversion.robot.map_file);
  for (const std::string& text : request.conversion.robot.objects) plan->Read(FileOfObjects(text));
}

RetargetReport RunRetargeting(const RetargetRequest& request,
                              const std::function<bool(int, int)>& progress) {
  const std::string& file = request.conversion.input.file;
  std::string output = request.conversion.output;
  if (output.empty() && HasMotion(request)) output = DefaultOutput(file);
  CheckFiles(request, output);
  const OpenedFiles opened;
  Warnings warnings;
  LoadedRobot robot = ReadRobot(request.conversion.robot, &warnings);
  RetargetReport report = {file,
                           "",
                           request.conversion.robot.file,
                           output,
                           std::move(robot.robot),
                           std::move(robot.body),
                           ReadObjects(request.conversion.robot.objects),
                           {},
                           {},
                           {},
                           {},
                           {}};
  CheckFiles(request, output);
  if (!HasMotion(request)) {
    RetargetRaisedKnee(&report, &warnings);
  } else if (request.converted != nullptr) {
    OpenedFiles::Note(request.converted->plan.opened);
    RetargetConversion(*request.converted, &report, &warnings);
  } else if (request.motion ||
             (request.conversion.input.recording.value == nullptr && IsFinishedMotion(file))) {
    CheckedMotion motion = request.motion
                               ? CheckedMotionOf(*request.motion, request.conversion.input)
                               : ReadCheckedMotion(request.conversion.input);
    CheckFiles(request, output);
    RetargetFinished(std::move(motion), &report, &warnings);
  } else {
    ConversionRequest conversion = request.conversion;
    conversion.output = output;
    RetargetConversion(RunConversion(conversion, LabelFirst(conversion, {}, progress), progress),
                       &report, &warnings);
  }
  report.figures = MeasureRetargeting(report.retargeted, report.robot, report.body);
  report.verdict = JudgeRetargeting(
      report.figures, report.conversion_verdict ? &*report.conversion_verdict : nullptr);
  if (const std::string doubt = DoubtOf(report.robot, report.body); !doubt.empty()) {
    AddDoubt(doubt, &report.verdict);
  }
  report.warnings = std::move(warnings);
  CheckFiles(request, output);
  report.opened = opened.files();
  return report;
}

RetargetRequest RequestFor(const ConversionRequest& conversion, const ConversionReport& converted) {
  RetargetRequest request;
  request.conversion = conversion;
  request.converted = &converted;
  return request;
}

void CheckRobotExport(const RobotExporter& format, const RobotRequest& robot,
                      const RetargetReport& report) {
  if (format.check != nullptr) format.check(report.robot, ExportOptionsOf(robot, report));
}

void WriteRobotExport(const RobotExporter& format, const std::string& file,
                      const RobotRequest& robot, RetargetReport* report) {
  ExportRobotMotion(format, file, ExportOptionsOf(robot, *report), report);
}

void ExportRobotMotion(const RobotExporter& format, const std::string& file,
                       const RobotExportOptions& options, RetargetReport* report) {
  const double own = format.rate > 0 ? format.rate : report->retargeted.motion.rate;
  const double rate = options.rate.value_or(own);
  RateFit* fit = IsExportRate(rate) ? FitAt(rate, report) : nullptr;  // else it is refused below
  const Retargeted& retargeted = fit ? fit->retargeted : report->retargeted;
  RobotExportOptions with_objects = options;
  for (const TrackedObject& object : retargeted.objects) {
    with_objects.objects.push_back(PosesAlways(object, retargeted.motion));
    with_objects.object_names.push_back(object.name);
  }
  format.write(file, report->robot, retargeted.motion, with_objects);
  if (fit != nullptr) {
    fit->files.push_back(file);
    TakeWorse(file, *fit, &report->verdict);
  }
  for (std::string& one : FilesOf(format, file)) report->written.push_back(std::move(one));
}

void WriteRobotMotion(RetargetReport* report) {
  MmmMotionOutput output;
  output.recording_name = fs::path(report->file).stem().string();
  output.motion_name = report->motion_name;
  output.model_path = ModelPathFor(report->robot_file, report->output);
  output.trajectory = &report->retargeted.motion;
  std::vector<PoseTrajectory> trajectories;
  std::vector<MmmMotionOutput> objects;
  trajectories.reserve(report->objects.size());  // their places stay
  for (std::size_t i = 0; i < report->objects.size(); ++i) {
    MmmMotionOutput& object = objects.emplace_back();
    object.motion_name = report->objects[i].recorded.name;
    object.model_path = ModelPathOf(report->objects[i], report->output);
    object.trajectory = &trajectories.emplace_back(
        PosesOf(report->retargeted.objects[i], report->retargeted.motion));
  }
  WriteFileAtomically(report->output, FormatMmmMotion2(output, objects));
  report->written.push_back(report->output);
}

}  // namespace mmm_converter
