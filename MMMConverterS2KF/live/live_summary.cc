// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/live/live_summary.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "MMMConverterS2KF/report/conversion_summary.h"
#include "common/judge/verdict.h"
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

}  // namespace

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

}  // namespace mmm_converter
