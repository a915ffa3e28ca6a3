// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/live/live_output.h"

#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "common/convert/tracking_start.h"
#include "common/live/source_address.h"
#include "common/model/posture.h"
#include "common/pipeline/live/live_plan.h"
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

LiveOutput::LiveOutput(const LiveRequest& request) : request_(request) {
  OutputPlan outputs;
  InputRequest inputs = request.input;
  inputs.file = FileOfSource(request.input.file);
  NameInputs(inputs, &outputs);
  outputs.Read(request.robot.file);
  outputs.Read(request.robot.map_file);
  outputs.Write(request.output);
  if (!request.output.empty()) outputs.Write(JournalOf(request.output));
  outputs.Write(request.subject_output);
  for (const auto& [unused, file] : request.exports) outputs.Write(file);
  for (const std::string& file : request.more_outputs) outputs.Write(file);
  outputs.Check();
}

std::string LiveOutput::FileOf(std::size_t motion) const {
  if (motion == 0) return request_.output;
  const std::filesystem::path output = request_.output;
  return (output.parent_path() /
          fmt::format("{}_{}{}", output.stem().string(), motion + 1, output.extension().string()))
      .string();
}

ConversionRequest LiveOutput::RequestOf(std::size_t motion) const {
  ConversionRequest request;
  request.input = request_.input;
  request.input.file = FileOf(motion);
  request.output = FileOf(motion);
  request.model_path = request_.model_path;
  if (motion == 0) request.exports = request_.exports;
  return request;
}

std::unique_ptr<PoseSink> LiveOutput::Begin(const ConversionPlan& plan, const LiveBody& body) {
  const std::size_t motion = plans_.size();
  plans_.push_back(plan);
  plans_.back().output = FileOf(motion);
  JournalHeader header;
  header.output = FileOf(motion);
  header.format = plan.output_format;
  header.motion = DescribeMotion(RequestOf(motion), plans_.back());
  if (!request_.robot.file.empty()) {
    header.format = "2.0";
    header.motion = {};
    header.motion.recording_name = plans_.back().motion_name;
    header.motion.motion_name = plans_.back().motion_name;
    header.motion.model_path = ModelPathFor(request_.robot.file, header.output);
  }
  header.rate = body.rate;
  header.labels = body.labels;
  for (const int joint : body.setup.joints) {
    header.joints.push_back(body.setup.model->joint(joint).name);
  }
  const bool is_recording = !FileOfSource(request_.input.file).empty();
  return std::make_unique<MotionJournal>(header, is_recording);
}

void LiveOutput::WriteRobotMotion(std::size_t motion, const JournalContent& content) {
  MmmMotionOutput output = content.header.motion;
  output.trajectory = &content.result.trajectory;
  WriteFileAtomically(FileOf(motion), FormatMmmMotion2(output));
  robot_motions_.push_back(FileOf(motion));
}

std::vector<ConversionReport> LiveOutput::Finish(
    const std::optional<CalibrationResult>& calibration) {
  std::vector<ConversionReport> reports;
  for (std::size_t i = 0; i < plans_.size(); ++i) {
    const std::string journal = JournalOf(FileOf(i));
    Warnings warnings;
    JournalContent content = ReadJournal(journal, &warnings);
    if (content.frames > 0 && !request_.robot.file.empty()) {
      WriteRobotMotion(i, content);
    } else if (content.frames > 0) {
      ConversionReport report;
      report.plan = std::move(plans_[i]);
      report.plan.output = FileOf(i);
      if (!calibration) TrackEarlier(report.plan, &content);
      report.plan.input.recording.markers = std::move(content.markers);
      report.result = std::move(content.result);
      report.warnings = std::move(warnings);
      if (i == 0) report.plan.calibration = calibration;
      if (i > 0) report.plan.subject_output.clear();
      MeasureAndJudge(&report);
      WriteConversion(RequestOf(i), &report);
      reports.push_back(std::move(report));
    }
    std::filesystem::remove(journal);
  }
  plans_.clear();
  return reports;
}

}  // namespace mmm_converter
