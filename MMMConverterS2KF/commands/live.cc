// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>

#include "MMMConverterS2KF/commands/commands.h"
#include "MMMConverterS2KF/commands/request_options.h"
#include "MMMConverterS2KF/live/live_output.h"
#include "MMMConverterS2KF/live/live_run.h"
#include "MMMConverterS2KF/live/live_sinks.h"
#include "MMMConverterS2KF/live/motion_journal.h"
#include "MMMConverterS2KF/report/conversion_page.h"
#include "MMMConverterS2KF/report/conversion_summary.h"
#include "MMMConverterS2KF/report/json.h"
#include "MMMConverterS2KF/terminal/command_line.h"
#include "MMMConverterS2KF/terminal/interruption.h"
#include "MMMConverterS2KF/terminal/log.h"
#include "MMMConverterS2KF/terminal/progress.h"
#include "common/judge/verdict.h"
#include "common/live/source_address.h"
#include "common/pipeline/exporters.h"
#include "common/support/atomic_file.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

std::string DescribeDelays(const LatencyHistogram& delays) {
  if (delays.count() == 0) return "no posture";
  return fmt::format("{:.3f} ms median, {:.3f} p99, {:.3f} longest",
                     kMilliseconds * delays.Quantile(0.5), kMilliseconds * delays.Quantile(0.99),
                     kMilliseconds * delays.longest());
}

Json DelaysJson(const LatencyHistogram& delays) {
  return {{"p50_ms", Number(kMilliseconds * delays.Quantile(0.5))},
          {"p99_ms", Number(kMilliseconds * delays.Quantile(0.99))},
          {"longest_ms", Number(kMilliseconds * delays.longest())}};
}

std::string DescribeRobot(const RetargetFigures& robot) {
  std::string text = fmt::format("{} frames", robot.num_frames);
  if (!std::isnan(robot.slide)) {
    text += fmt::format(
        "; feet slide in {:.1f} % of those in contact, are {:.1f} mm above the floor then, and at "
        "most {:.1f} below",
        kPercent * robot.slide, kMillimetres * robot.floating, kMillimetres * robot.penetration);
  }
  if (!std::isnan(robot.direction)) {
    text += fmt::format("; limbs {:.1f} degrees from the person's", kDegrees * robot.direction);
  }
  text += fmt::format(
      "; joints {:.3g} rad/s^2 rms, the root at most {:.1f} m/s; lost the person {} "
      "times and held for {:.1f} s, jumped {} times",
      robot.acceleration, robot.root_speed, robot.followed.holds, robot.followed.held,
      robot.followed.jumps);
  return text + fmt::format("; limits of position broken {} times, of velocity {} times",
                            robot.position_breaks, robot.velocity_breaks);
}

Json RobotJson(const RetargetFigures& robot, const Verdict& verdict) {
  Json joints = Json::array();
  for (const JointFigures& joint : robot.joints) {
    joints.push_back({{"name", joint.name},
                      {"at_position_limit", Number(joint.share_at_limit)},
                      {"at_velocity_limit", Number(joint.share_at_speed)}});
  }
  return {{"frames", robot.num_frames},
          {"contact", Number(robot.contact_share)},
          {"slide", Number(robot.slide)},
          {"penetration_m", Number(robot.penetration, 6)},
          {"floating_m", Number(robot.floating, 6)},
          {"direction_rad", Number(robot.direction)},
          {"acceleration_rad_s2", Number(robot.acceleration)},
          {"root_speed_m_s", Number(robot.root_speed)},
          {"holds", robot.followed.holds},
          {"held_s", Number(robot.followed.held)},
          {"returns", robot.followed.returns},
          {"jumps", robot.followed.jumps},
          {"position_limits_broken", robot.position_breaks},
          {"velocity_limits_broken", robot.velocity_breaks},
          {"joints_at_limits", joints},
          {"verdict", ToJson(verdict)}};
}

std::string FormatSummary(const LiveReport& report) {
  std::string text = fmt::format(
      "source     {}; {} connection{}, {} lost and {} broken on the way\n",
      report.source.empty() ? "gave no frame" : report.source, report.counts.connections,
      report.counts.connections == 1 ? "" : "s", report.counts.lost, report.counts.broken);
  text += fmt::format(
      "frames     {} taken in {:.1f} s, {} dropped for newer ones, {} tracked in {} "
      "part{}\n",
      report.frames, report.seconds, report.dropped, report.tracked, report.starts,
      report.starts == 1 ? "" : "s");
  for (const OtherObject& object : report.objects) {
    text += fmt::format("object     {}: {} tracked in {} part{}\n", object.name, object.tracked,
                        object.starts, object.starts == 1 ? "" : "s");
  }
  text += fmt::format("delay      received to taken: {}\n", DescribeDelays(report.waits));
  text += fmt::format("           received to tracked: {}\n", DescribeDelays(report.delays));
  for (const SinkReport& sink : report.sinks) {
    text += fmt::format("sent       {}: {} frames, {} lost; received to sent: {}{}\n", sink.name,
                        sink.written, sink.lost, DescribeDelays(sink.delays),
                        sink.failure.empty() ? "" : "; failed: " + sink.failure);
  }
  for (const ConversionReport& motion : report.motions) text += FormatSummary(motion);
  if (report.robot) {
    text += fmt::format("robot      {}\n", DescribeRobot(*report.robot));
    text += fmt::format("verdict    {}\n", DescribeVerdict(*report.robot_verdict));
  }
  for (const std::string& file : report.robot_motions) {
    text += fmt::format("written    {}, the robot's motion\n", file);
  }
  return text;
}

Json ToJson(const LiveReport& report) {
  Json sinks = Json::array();
  for (const SinkReport& sink : report.sinks) {
    sinks.push_back({{"name", sink.name},
                     {"written", sink.written},
                     {"lost", sink.lost},
                     {"received_to_sent", DelaysJson(sink.delays)},
                     {"failure", TextOrNull(sink.failure)}});
  }
  Json motions = Json::array();
  for (const ConversionReport& motion : report.motions) motions.push_back(ToJson(motion));
  Json objects = Json::array();
  for (const OtherObject& object : report.objects) {
    objects.push_back(
        {{"name", object.name}, {"tracked", object.tracked}, {"parts", object.starts}});
  }
  return {{"source", report.source},
          {"connections", report.counts.connections},
          {"frames_lost", report.counts.lost},
          {"broken_messages", report.counts.broken},
          {"frames", report.frames},
          {"dropped", report.dropped},
          {"tracked", report.tracked},
          {"parts", report.starts},
          {"objects", objects},
          {"seconds", Number(report.seconds, 3)},
          {"received_to_taken", DelaysJson(report.waits)},
          {"received_to_tracked", DelaysJson(report.delays)},
          {"sinks", sinks},
          {"motions", motions},
          {"robot_motions", report.robot_motions},
          {"robot", report.robot ? RobotJson(*report.robot, *report.robot_verdict) : Json()}};
}

const OptionGroup kOutputOptions = {
    "Files",
    {{"output,o", "FILE",
      "the motion; it is kept in FILE.live while it comes, so that nothing is lost", ""},
     {"to", "ADDRESS",
      "send postures: mvn://HOST:PORT (Xsens MVN, UDP), zmq://HOST:PORT (ZeroMQ publisher), "
      "ws://HOST:PORT (WebSocket server); may be given several times",
      "", true},
     {"view", "", "serve a page to watch it, for browsers on this machine", ""},
     {"view-at", "HOST:PORT", "where --view listens; default: 127.0.0.1 and a free port", ""},
     {"report", "FILE", "write a page (HTML) of the motion at the end", ""},
     {"summary", "FILE", "write a summary as JSON", ""}}};

const std::vector<OptionGroup> kOtherOptions = {
    {"Calibration",
     {{"calibrate-seconds", "S", "how long to gather movement for it; default: 15", ""},
      {"subject-out", "FILE", "with --self-calibrate: also write the person", ""}}},
    {"Robot that follows",
     {{"joint-speed", "RAD/S", "the most of any joint; default: its own, or 20", ""},
      {"joint-acceleration", "RAD/S2", "the most of any joint; default: 200", ""},
      {"root-speed", "M/S", "the most of its root; default: 6", ""},
      {"rest-after", "S",
       "how long it holds where it is while nobody is seen, before it goes to its posture at rest; "
       "default: 2",
       ""}}},
    {"Running",
     {{"loop", "", "a replay begins again at its end", ""},
      {"seconds", "S", "end after so many seconds; default: when the source ends, or with Ctrl-C",
       ""},
      {"realtime", "",
       "ask the system for real-time priority of the threads that read, track and send", ""},
      {"processor", "N", "keep the tracking thread on this processor", ""}}}};

constexpr const char* kLiveUsage = R"(MMMConverterS2KF live SOURCE [options]
Tracks while frames come, until the source ends or Ctrl-C is pressed. SOURCE is one of
{}
{}Examples
  MMMConverterS2KF live qtm://192.168.0.10 --subject-file anna.xml -o walk_mmm.xml --view
  MMMConverterS2KF live natnet://192.168.0.11 --height 1.75 --self-calibrate --to mvn://127.0.0.1
  MMMConverterS2KF live qtm://192.168.0.10 --label --subject-file anna.xml --view
  MMMConverterS2KF live qtm://192.168.0.10 --height 1.75 --robot g1.urdf --to zmq://127.0.0.1
  MMMConverterS2KF live natnet://192.168.0.11 --model box.xml --and-model lamp.xml -o scene.xml
  MMMConverterS2KF live replay:walk.c3d@2 --height 1.75 --to zmq://127.0.0.1:5556
)";

// What frames that come one by one can be exported to.
std::vector<Exporter> LiveExporters() {
  std::vector<Exporter> exporters = Exporters();
  std::erase_if(exporters, [](const Exporter& one) { return one.of_covariances; });
  return exporters;
}

void CheckNeedsOutput(const Arguments& arguments, const LiveRequest& request) {
  if (!request.output.empty()) return;
  std::vector<std::string> options = {"report", "format", "model-path", "subject-out"};
  for (const Exporter& exporter : LiveExporters()) options.emplace_back(exporter.option);
  for (const std::string& option : options) {
    if (arguments.Has(option)) {
      throw UsageError(
          fmt::format("live: --{} is of a motion that is written; give -o too", option));
    }
  }
}

void CheckRobot(const Arguments& arguments, const LiveRequest& request) {
  if (request.robot.file.empty()) {
    for (const char* option : {"map", "sole-height", "sole", "hold", "weights", "joint-speed",
                               "joint-acceleration", "root-speed", "rest-after"}) {
      if (!arguments.Has(option)) continue;
      throw UsageError(fmt::format("live: --{} is of a robot; give --robot too", option));
    }
    return;
  }
  std::vector<std::string> options = {"report", "format", "model-path", "subject-out"};
  for (const Exporter& exporter : LiveExporters()) options.emplace_back(exporter.option);
  for (const std::string& option : options) {
    if (!arguments.Has(option)) continue;
    throw UsageError(fmt::format(
        "live: --{} is of the person's motion, and --robot gives the robot's; retarget has what "
        "robots' motions are exported to",
        option));
  }
  const std::string ending = std::filesystem::path(request.output).extension().string();
  if (ending == ".mot" || ending == ".sto") {
    throw UsageError(
        fmt::format("live: {}: a robot's motion is written as MMM's .xml only", request.output));
  }
  for (const std::string& address : request.sinks) {
    if (!address.starts_with("mvn:")) continue;
    throw UsageError(fmt::format(
        "live: {} takes persons only; send a robot's postures to zmq:// or ws://", address));
  }
}

FollowOptions FollowOptionsOf(const Arguments& arguments) {
  FollowOptions options;
  const auto read = [&](const char* name, double least, double most, const char* unit) {
    const auto value = arguments.GetNumber(name, unit);
    if (value && !(*value >= least && *value <= most)) {
      throw UsageError(fmt::format("live: --{} is {}, from {:g} to {:g}", name, unit, least, most));
    }
    return value;
  };
  options.joint_speed = read("joint-speed", 0.01, 1000, "rad/s");
  options.joint_acceleration = read("joint-acceleration", 0.1, 1e5, "rad/s^2");
  options.root_speed = read("root-speed", 0.01, 100, "m/s");
  options.rest_after = read("rest-after", 0, 1e6, "seconds");
  return options;
}

LiveRequest MakeLiveRequest(const Arguments& arguments) {
  if (!arguments.positional()) {
    throw UsageError(
        "live: which source? For instance: MMMConverterS2KF live qtm://192.168.0.10 --height 1.75 "
        "-o "
        "motion.xml");
  }
  LiveRequest request;
  static_cast<ConversionRequest&>(request) =
      MakeRequest(task::kLive, arguments, *arguments.positional());
  request.loops = arguments.Has("loop");
  const auto calibration = arguments.GetNumber("calibrate-seconds", "seconds, e.g. 15");
  if (request.self_calibrate) {
    request.calibration_time = calibration.value_or(kDefaultCalibration);
    if (!IsCalibrationTime(request.calibration_time)) {
      throw UsageError(fmt::format("live: --calibrate-seconds is {}", DescribeCalibrationTime()));
    }
  } else if (calibration || arguments.Has("subject-out")) {
    throw UsageError("live: --calibrate-seconds and --subject-out need --self-calibrate");
  }
  request.subject_output = arguments.Get("subject-out").value_or("");
  request.output = arguments.Get("output").value_or("");
  request.exports = ExportsOf(arguments);
  for (const char* option : {"summary", "report"}) {
    if (const auto file = arguments.Get(option)) request.more_outputs.push_back(*file);
  }
  request.follow = FollowOptionsOf(arguments);
  request.sinks = arguments.GetAll("to");
  request.view_address = arguments.Get("view-at").value_or("");
  request.view = arguments.Has("view") || !request.view_address.empty();
  request.longest = arguments.GetNumber("seconds", "seconds, e.g. 60").value_or(0);
  request.realtime = arguments.Has("realtime");
  request.processor = arguments.GetInteger("processor", 0, 1023).value_or(-1);
  CheckRobot(arguments, request);
  CheckNeedsOutput(arguments, request);
  return request;
}

std::string Describe(const LiveStatus& status) {
  std::string text =
      fmt::format("{} frames, {} dropped: {}", status.frames, status.dropped, status.text);
  if (status.stage == LiveStage::kGathering || status.stage == LiveStage::kMeasuring) {
    text += fmt::format(", {:.0f} %", 100 * status.gathered);
  }
  return text;
}

}  // namespace

Manual LiveManual() {
  std::vector<OptionGroup> last = kOtherOptions;
  last.push_back(ExportGroup("Export, at the end", LiveExporters()));
  return {fmt::format(kLiveUsage, DescribeSources(), "{}"),
          CommandOptions(task::kLive, {kOutputOptions}, last)};
}

int RunLive(const Arguments& arguments) {
  StartLog(arguments.Get("log").value_or("info"));
  const LiveRequest request = MakeLiveRequest(arguments);
  for (const std::string& motion : FirstMotions(request)) {
    Warnings warnings;
    const std::string recovered = RecoverMotion(motion, &warnings);
    if (recovered.empty()) continue;
    LogWarning(
        fmt::format("{}: the motion of a run that was killed is now in {}", motion, recovered));
    LogWarnings(warnings);
  }
  StatusLine line;
  LiveReport report;
  {
    const InterruptionWatch watch;
    const auto clearing = [&line](void (*log)(const std::string&)) {
      return [&line, log](const std::string& text) {
        line.Clear();
        log(text);
      };
    };
    report = TrackLive(request, {clearing(LogInfo), clearing(LogWarning),
                                 [&](const LiveStatus& status) { line.Show(Describe(status)); },
                                 [] { return InterruptionWatch::Signal() != 0; }});
  }
  line.Clear();
  for (const ConversionReport& motion : report.motions) LogWarnings(motion.warnings);
  if (const auto file = arguments.Get("summary")) {
    WriteFileAtomically(*file, FormatJson(ToJson(report)));
  }
  if (const auto file = arguments.Get("report")) {
    const bool has_motion =
        !report.motions.empty() && report.motions.front().plan.output == request.output;
    if (has_motion) {
      WriteFileAtomically(*file, FormatConversionPage({&report.motions.front()}));
    } else {
      LogWarning(fmt::format("{}: is not written, as there is no {} that it would show", *file,
                             request.output));
    }
  }
  std::cout << FormatSummary(report);
  std::vector<Verdict::Level> verdicts;
  verdicts.reserve(report.motions.size());
  for (const ConversionReport& motion : report.motions) verdicts.push_back(motion.verdict.level);
  if (report.robot_verdict) verdicts.push_back(report.robot_verdict->level);
  return ExitCodeOf(arguments, verdicts);
}

}  // namespace mmm_converter
