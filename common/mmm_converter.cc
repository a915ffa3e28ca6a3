// SPDX-License-Identifier: MIT
#include "common/mmm_converter.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "common/convert/live_tracker.h"
#include "common/convert/tracked_joints.h"
#include "common/io/recording/marker_recording.h"
#include "common/pipeline/conversion_options.h"
#include "common/pipeline/finished_work.h"
#include "common/pipeline/live_plan.h"
#include "common/support/text.h"
#include "common/support/units.h"

namespace mmm {

namespace core = mmm_converter;

struct Recording::Content {
  std::shared_ptr<const core::Recording> recording;
  core::Warnings warnings;
  Options options;  ///< that it was read with
};

struct Tracker::State {
  core::ConversionPlan plan;  // its plugin outlives the converter
  std::optional<core::LiveTracker> tracker;
  std::vector<std::string> joint_names, markers, warnings;
  Eigen::Index num_labels = 0;
  TrackedFrame frame;
};

namespace {

constexpr core::Medium kMedium = core::Medium::kPython;  // whose names the options have

const char* NameOf(Task task) {
  constexpr const char* kNames[] = {"Read", "Convert", "Calibrate", "Tracker"};
  return kNames[static_cast<int>(task)];
}

bool IsOf(Task task, const core::Option& option) {
  const std::string group = option.group;
  if (*option.names.keyword == 0 || group == "Page") return false;
  if (task == Task::kRead) return (option.tasks & core::task::kRead) != 0;
  if (task == Task::kConvert) return (option.tasks & core::task::kConvert) != 0;
  if (task == Task::kCalibrate) return (option.tasks & core::task::kCalibrate) != 0;
  const bool is_known_before = group == "Person and model" || group == "Converter";
  return is_known_before && (option.tasks & core::task::kLive) != 0;
}

/// What is asked for.
struct Request {
  core::ConversionRequest conversion;
  std::string name;  ///< of a calibrated person
};

std::vector<core::Option> TableOf(Task task, Request* request) {
  std::vector<core::Option> table = core::Options(&request->conversion);
  table.push_back(core::Row({"", "", "with_unlabelled"}, {},
                            "also points without a label, which \"label\" finds names for", "",
                            core::task::kRead, &request->conversion.input.reading.with_unlabelled));
  table.push_back(core::Row({"", "", "name"}, {core::OptionKind::kText, "NAME"}, "of the person",
                            "what the first recording calls it", core::task::kCalibrate,
                            &request->name));
  std::erase_if(table, [&](const core::Option& option) { return !IsOf(task, option); });
  return table;
}

const core::Option* Find(const std::vector<core::Option>& table, const std::string& name) {
  const auto row = std::find_if(table.begin(), table.end(), [&](const core::Option& option) {
    return option.names.keyword == name;
  });
  return row == table.end() ? nullptr : &*row;
}

void ReadOptions(Task task, const Options& options, Request* request) {
  const std::vector<core::Option> table = TableOf(task, request);
  for (const auto& [name, value] : options) {
    const core::Option* option = Find(table, name);
    if (option == nullptr) {
      std::vector<std::string> names;
      names.reserve(table.size());
      for (const core::Option& one : table) names.emplace_back(one.names.keyword);
      throw Error(fmt::format("there is no option \"{}\" of {}; there are {}", name, NameOf(task),
                              core::JoinNames(names, " and ")));
    }
    const bool is_several = !core::IsList(*option) && value.texts().size() != 1;
    const std::string expected =
        is_several ? "it is one value" : core::SetOption(*option, value.texts());
    if (expected.empty()) continue;
    throw Error(fmt::format("{}: \"{}\" is not allowed; {}", name,
                            core::JoinNames(value.texts(), ", "), expected));
  }
}

/// Names options as they are called here.
core::Wording MakeWording() {
  const auto advise = [](core::Remedy remedy) -> std::string {
    if (remedy == core::Remedy::kLabels) return "; the option \"label\" finds names";
    for (const core::Option& option : core::DescribedOptions()) {
      const bool is_it = remedy != core::Remedy::kNone && option.notes.remedy == remedy;
      if (is_it) return fmt::format(" (option \"{}\")", core::NameIn(kMedium, option));
    }
    return "";
  };
  return {core::WordingOf(kMedium).option, advise};
}

void UseWordingOnce() {
  static const bool is_used = (core::SetWording(MakeWording()), true);
  static_cast<void>(is_used);
}

/// Errors say what to do.
template <typename Work>
auto Told(const Work& work) {
  UseWordingOnce();
  try {
    return work();
  } catch (const WriteError&) {
    throw;
  } catch (const Error& error) {
    throw Error(core::WithAdvice(error), error.remedy());
  }
}

}  // namespace

/// What only these classes' functions may see.
class Requests {
 public:
  static void UseRecording(Task task, const Recording& recording, const Options& options,
                           Request* request) {
    const Recording::Content& content = *recording.content_;
    Request unused;
    const std::vector<core::Option> of_reading = TableOf(Task::kRead, &unused);
    for (const auto& [name, value] : options) {
      const auto was_read = content.options.find(name);
      const bool is_same =
          was_read != content.options.end() && was_read->second.texts() == value.texts();
      if (is_same || Find(of_reading, name) == nullptr) continue;
      throw Error(name + ": the recording was read without it; give it to Read");
    }
    ReadOptions(Task::kRead, content.options, request);
    ReadOptions(task, options, request);
    request->conversion.input.recording = {content.recording, content.warnings};
    request->conversion.input.file = content.recording->file;
  }

  static Conversion Run(const Request& request, const Progress& progress) {
    return Conversion(std::make_shared<core::FinishedConversion>(
        core::FinishConversion(request.conversion, progress)));
  }

  static Person Run(const core::CalibrationRequest& request, const Progress& progress) {
    return Person(std::make_shared<const core::FinishedCalibration>(
        core::FinishCalibration(request, progress)));
  }
};

Value::Value(bool is_on) : texts_{is_on ? "true" : "false"} {}
Value::Value(int number) : texts_{std::to_string(number)} {}
Value::Value(double number) : texts_{fmt::format("{}", number)} {}
Value::Value(const char* text) : texts_{text} {}
Value::Value(std::string text) : texts_{std::move(text)} {}
Value::Value(std::vector<std::string> texts) : texts_(std::move(texts)) {}

std::map<std::string, std::string> DescribeOptions(Task task) {
  constexpr core::Task kTasks[] = {core::task::kRead, core::task::kConvert, core::task::kCalibrate,
                                   core::task::kLive};
  Request unused;
  std::map<std::string, std::string> described;
  for (const core::Option& option : TableOf(task, &unused)) {
    described[option.names.keyword] = core::HelpOf(kMedium, option, kTasks[static_cast<int>(task)]);
  }
  return described;
}

Recording::Recording(MarkerSequence markers, const std::string& name) {
  Told([&] {
    auto recording =
        std::make_shared<core::Recording>(core::MakeRecording(std::move(markers), name));
    content_ = std::make_shared<const Content>(Content{std::move(recording), {}, {}});
  });
}

const std::string& Recording::file() const { return content_->recording->file; }
const std::string& Recording::format() const { return content_->recording->format; }
const MarkerSequence& Recording::markers() const { return content_->recording->markers; }
std::vector<std::string> Recording::warnings() const { return content_->warnings.texts(); }

Recording Read(const std::string& file, const Options& options) {
  return Told([&] {
    Request request;
    ReadOptions(Task::kRead, options, &request);
    Recording::Content content;
    content.options = options;
    content.recording = std::make_shared<const core::Recording>(
        core::ReadRecording(file, request.conversion.input.reading, &content.warnings));
    return Recording(std::make_shared<const Recording::Content>(std::move(content)));
  });
}

const Verdict& Conversion::verdict() const { return work_->report.verdict; }
std::vector<std::string> Conversion::warnings() const { return work_->report.warnings.texts(); }
const PoseTrajectory& Conversion::motion() const { return work_->trajectory(); }

AnatomicalAngles Conversion::anatomical_angles() const {
  return Told([&] {
    return core::ComputeAnatomicalAngles(*work_->report.plan.setup.model, work_->trajectory());
  });
}

std::vector<std::string> Conversion::markers() const {
  const core::ConversionPlan& plan = work_->report.plan;
  return core::UsedLabels(plan.setup, plan.input.recording.markers.labels());
}

const Eigen::MatrixXd& Conversion::distances() const { return work_->report.result.residuals; }
double Conversion::mean_distance() const { return work_->report.figures.distance.mean; }
double Conversion::height() const { return work_->report.plan.person.height.value; }
const std::string& Conversion::marker_set() const { return work_->report.plan.setup.marker_set; }

void Conversion::Save(const std::string& file) {
  Told([&] { core::SaveMotion(file, work_.get()); });
}

void Conversion::Export(const std::string& name, const std::string& file) {
  Told([&] { core::SaveExport(name, file, work_.get()); });
}

Conversion Convert(const std::string& file, const Options& options, const Progress& progress) {
  return Told([&] {
    Request request;
    ReadOptions(Task::kConvert, options, &request);
    request.conversion.input.file = file;
    return Requests::Run(request, progress);
  });
}

Conversion Convert(const Recording& recording, const Options& options, const Progress& progress) {
  return Told([&] {
    Request request;
    Requests::UseRecording(Task::kConvert, recording, options, &request);
    return Requests::Run(request, progress);
  });
}

std::map<std::string, std::string> DescribeExports() {
  std::map<std::string, std::string> described;
  for (const core::Exporter& one : core::Exporters()) described[one.name] = one.what;
  return described;
}

const Verdict& Person::verdict() const { return work_->report.verdict; }
std::vector<std::string> Person::warnings() const { return work_->report.warnings.texts(); }
const Subject& Person::subject() const { return work_->report.result.subject; }
double Person::mean_distance() const { return work_->report.result.distance_after; }
double Person::mean_distance_before() const { return work_->report.result.distance_before; }

void Person::Save(const std::string& file) const {
  Told([&] { core::SaveSubject(*work_, file); });
}

void Person::SaveModel(const std::string& file) const {
  Told([&] { core::SaveSubjectsModel(*work_, file); });
}

Person Calibrate(const std::vector<Recording>& recordings, const Options& options,
                 const Progress& progress) {
  return Told([&] {
    core::CalibrationRequest calibration;
    for (const Recording& recording : recordings) {
      Request request;
      Requests::UseRecording(Task::kCalibrate, recording, options, &request);
      calibration.converter = request.conversion.converter;
      calibration.name = request.name;
      calibration.inputs.push_back(std::move(request.conversion.input));
    }
    return Requests::Run(calibration, progress);
  });
}

Tracker::Tracker(const std::vector<std::string>& labels, double rate, const Options& options)
    : state_(std::make_shared<State>()) {
  Told([&] {
    Request request;
    ReadOptions(Task::kTrack, options, &request);
    core::CheckFrameRate(rate);
    core::LiveRequest live;
    static_cast<core::ConversionRequest&>(live) = std::move(request.conversion);
    core::Recording head = core::MakeRecording(MarkerSequence(labels, 1, rate, 0), "the frames");
    head.format = "live stream";
    State& state = *state_;
    state.plan = core::PlanLive(live, head);
    const core::TrackingSetup& setup = state.plan.setup;
    state.tracker.emplace(core::MakeConverter(state.plan, setup), rate);
    state.joint_names = core::TrackedJoints(setup);
    state.markers = core::UsedLabels(setup, labels);
    state.warnings = state.plan.warnings.texts();
    state.num_labels = static_cast<Eigen::Index>(labels.size());
    state.frame.standard_deviations.setConstant(6 + static_cast<Eigen::Index>(setup.joints.size()),
                                                core::kNaN);
  });
}

const TrackedFrame* Tracker::Track(const Eigen::Ref<const Eigen::Matrix3Xd>& points, double time) {
  State& state = *state_;
  if (points.cols() != state.num_labels) {
    throw Error(
        fmt::format("the frame has {} points; its labels are {}", points.cols(), state.num_labels));
  }
  const core::FrameEstimate* estimate = state.tracker->Track(points, time);
  if (estimate == nullptr) return nullptr;
  TrackedFrame& frame = state.frame;
  core::TakeTracked(state.tracker->setup(), *estimate, &frame.posture, frame.standard_deviations);
  frame.distances = estimate->residuals;
  frame.markers_seen = estimate->markers_seen;
  frame.markers_wrong = estimate->markers_wrong;
  frame.converged = estimate->converged;
  frame.reassembled = estimate->reassembled;
  return &frame;
}

void Tracker::Prepare() { state_->tracker->Prepare(); }
void Tracker::Restart() { state_->tracker->Restart(); }
const std::vector<std::string>& Tracker::joint_names() const { return state_->joint_names; }
const std::vector<std::string>& Tracker::markers() const { return state_->markers; }
const std::vector<std::string>& Tracker::warnings() const { return state_->warnings; }

}  // namespace mmm
