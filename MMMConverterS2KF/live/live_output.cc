// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/live/live_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "common/convert/tracking_start.h"
#include "common/io/tables/osim_tables.h"
#include "common/live/source_address.h"
#include "common/model/posture.h"
#include "common/pipeline/force_exports.h"
#include "common/pipeline/live/live_bodies.h"
#include "common/pipeline/live_plan.h"
#include "common/pipeline/motion_output.h"
#include "common/support/atomic_file.h"
#include "common/support/output_plan.h"

namespace mmm_converter {
namespace {

// What came before the first posture is tracked backward, as by MotionConverter::Convert.
void TrackEarlier(const ConversionPlan& plan, JournalContent* content) {
  const int first = content->first_tracked;
  const auto is_seen = [&](int k) {
    return CountSeen(content->markers.frame(k), plan.setup) >= kFewestMarkers;
  };
  if (first == 0 || !is_seen(first)) return;
  int earliest = 0;
  while (!is_seen(earliest)) ++earliest;
  const auto converter = MakeConverter(plan, plan.setup);
  ResultWriter writer(content->markers, plan.setup, &content->verdicts, &content->result);
  writer.WriteEarlier(TrackBackward(content->markers, first, earliest, converter.get(),
                                    [&](int k, const FrameEstimate& estimate, double seconds) {
                                      writer.Write(k, estimate, seconds);
                                    }));
  writer.FindIncidents();
}

}  // namespace

std::vector<std::string> FirstMotions(const LiveRequest& request) {
  if (request.output.empty()) return {};
  std::vector<std::string> files = {request.output};
  for (const std::string& model : request.other_objects) {
    files.push_back(OutputOfObject(request.output, std::filesystem::path(model).stem().string()));
  }
  return files;
}

LiveOutput::LiveOutput(const LiveRequest& request) : request_(request) { CheckFiles(); }

// plan: of a motion that begins; null: none does yet.
void LiveOutput::CheckFiles(const ConversionPlan* plan) const {
  const LiveRequest& request = request_;
  OutputPlan outputs;
  InputRequest inputs = request.input;
  inputs.file = FileOfSource(request.input.file);
  NameInputs(inputs, &outputs);
  outputs.Read(request.robot.file);
  outputs.Read(request.robot.map_file);
  for (const std::string& file : FirstMotions(request)) {
    outputs.Write(file);
    outputs.Write(JournalOf(file));
  }
  outputs.Write(request.subject_output);
  NameOutputs(request.exports, &outputs);
  for (const std::string& file : request.more_outputs) outputs.Write(file);
  for (const std::string& file : request.other_objects) outputs.Read(file);
  if (plan != nullptr) {
    outputs.Read(plan->opened);
    outputs.WriteBeside(DeviationsOutput(*plan), kOsimDeviations);
    const std::vector<std::string> first = FirstMotions(request);
    if (std::count(first.begin(), first.end(), plan->output) == 0) outputs.Write(plan->output);
  }
  outputs.Check();
}

std::string LiveOutput::FileOf(const Motion& motion) const {
  const std::filesystem::path first = motion.plan.output;
  if (motion.number == 0) return first.string();
  const std::string name =
      fmt::format("{}_{}{}", first.stem().string(), motion.number + 1, first.extension().string());
  return (first.parent_path() / name).string();
}

ConversionRequest LiveOutput::RequestOf(const Motion& motion) const {
  ConversionRequest request;
  request.input = request_.input;
  request.input.file = motion.file;
  request.output = motion.file;
  request.model_path = request_.model_path;
  if (motion.body > 0) {
    request.input.model_file = motion.plan.input.model_file;
    request.model_path.clear();
  }
  if (motion.is_first()) request.exports = request_.exports;
  return request;
}

std::unique_ptr<PoseSink> LiveOutput::Begin(const ConversionPlan& plan, const LiveBody& body) {
  Motion motion;
  motion.plan = plan;
  motion.body = body.index;
  motion.number =
      static_cast<int>(std::count_if(motions_.begin(), motions_.end(), [&](const Motion& earlier) {
        return earlier.body == body.index;
      }));
  motion.file = motion.plan.output = FileOf(motion);
  CheckFiles(&motion.plan);
  JournalHeader header;
  header.output = motion.file;
  header.format = plan.output_format;
  header.motion = DescribeMotion(RequestOf(motion), motion.plan);
  if (IsRobots(motion)) {
    header.format = "2.0";
    header.motion = {};
    header.motion.recording_name = plan.motion_name;
    header.motion.motion_name = plan.motion_name;
    header.motion.model_path = ModelPathFor(request_.robot.file, header.output);
  }
  header.rate = body.rate;
  header.labels = body.labels;
  for (const int joint : body.setup.joints) {
    header.joints.push_back(body.setup.model->joint(joint).name);
  }
  motions_.push_back(std::move(motion));
  const bool is_recording = !FileOfSource(request_.input.file).empty();
  return std::make_unique<MotionJournal>(header, is_recording);
}

void LiveOutput::Update(const ConversionPlan& plan, int body) {
  const auto last = std::find_if(motions_.rbegin(), motions_.rend(),
                                 [&](const Motion& motion) { return motion.body == body; });
  last->plan = plan;
}

void LiveOutput::WriteRobotMotion(const Motion& motion, const JournalContent& content) {
  MmmMotionOutput output = content.header.motion;
  output.trajectory = &content.result.trajectory;
  WriteFileAtomically(motion.file, FormatMmmMotion2(output));
  robot_motions_.push_back(motion.file);
}

std::vector<ConversionReport> LiveOutput::Finish(
    const std::optional<CalibrationResult>& calibration) {
  std::vector<ConversionReport> reports;
  std::stable_sort(motions_.begin(), motions_.end(),
                   [](const Motion& a, const Motion& b) { return a.body < b.body; });
  for (Motion& motion : motions_) {
    const std::string journal = JournalOf(motion.file);
    Warnings warnings;
    JournalContent content = ReadJournal(journal, &warnings);
    if (content.frames > 0 && IsRobots(motion)) {
      WriteRobotMotion(motion, content);
    } else if (content.frames > 0) {
      ConversionReport report;
      report.plan = motion.plan;
      report.plan.output = motion.file;
      if (!calibration || motion.body > 0) TrackEarlier(report.plan, &content);
      report.plan.input.recording.markers = std::move(content.markers);
      report.result = std::move(content.result);
      report.warnings = std::move(warnings);
      if (motion.is_first()) report.plan.calibration = calibration;
      if (!motion.is_first()) report.plan.subject_output.clear();
      MeasureAndJudge(&report);
      const ConversionRequest request = RequestOf(motion);
      StudyExports(request.exports, &report);
      WriteConversion(request, &report);
      reports.push_back(std::move(report));
    }
    std::filesystem::remove(journal);
  }
  motions_.clear();
  return reports;
}

}  // namespace mmm_converter
