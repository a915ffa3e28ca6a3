// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/report/retarget_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "MMMConverterS2KF/report/conversion_summary.h"
#include "MMMConverterS2KF/report/ground_json.h"
#include "common/support/text.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

constexpr std::size_t kLimbsShown = 3, kTouchesShown = 3;

std::string RetargetLine(const std::string& name, const std::string& text) {
  return fmt::format("{:<12}{}\n", name, text);
}

/// Without a minus before nothing.
double Millimetres(double metres) {
  const double tenths = std::round(10 * kMillimetres * metres);
  return tenths == 0 ? 0 : tenths / 10;
}

std::string DescribeFeet(const RetargetReport& report) {
  const RetargetFigures& figures = report.figures;
  std::string text = RetargetLine("sole", (*report.body.feet)[0].said);
  if (std::isnan(figures.slide)) {
    text += RetargetLine("feet", "the person's feet are nowhere in contact");
  } else {
    std::string feet = fmt::format(
        "slide in {:.1f} % of the frames in contact{}", kPercent * figures.slide,
        std::isnan(figures.toe_slide)
            ? ""
            : fmt::format(" ({:.1f} % by the toe's rule at 30 Hz)", kPercent * figures.toe_slide));
    if (!std::isnan(figures.floating)) {
      feet += fmt::format(", {:.1f} mm above what they stand on in contact",
                          Millimetres(figures.floating));
    }
    text += RetargetLine("feet", feet);
  }
  std::string floor = fmt::format("feet at most {:.1f} mm below it, at {:.2f} s",
                                  kMillimetres * figures.penetration, figures.penetration_time);
  const double belt = report.retargeted.belt.norm();
  if (belt > 0) floor += fmt::format("; it is a treadmill's belt, at {:.2f} m/s", belt);
  if (figures.highest_stance > 0) {
    floor += fmt::format("; they stand on what is up to {:.2f} m above it", figures.highest_stance);
  }
  if (figures.body_depth > 0) {
    floor += fmt::format("; {} {:.1f} mm at {:.2f} s", figures.deepest_body,
                         kMillimetres * figures.body_depth, figures.body_depth_time);
  }
  return text + RetargetLine("floor", floor);
}

std::string DescribeTouches(const RetargetReport& report) {
  const RobotCapsules& capsules = report.body.capsules;
  const std::vector<TouchFigures>& touches = report.figures.touches;
  std::string text = fmt::format("{} pairs of bodies are watched", capsules.pairs.size());
  text += touches.empty() ? ", and none touch" : fmt::format(", {} touch", touches.size());
  for (std::size_t i = 0; i < std::min(touches.size(), kTouchesShown); ++i) {
    const TouchFigures& one = touches[i];
    text += fmt::format("; {} {:.1f} mm in {}{} at {:.2f} s", one.first, Millimetres(one.depth),
                        one.second, one.is_by_mass ? " (by their inertia)" : "", one.time);
  }
  if (!capsules.unknown.empty()) {
    text += "; of what size these are is not known: " + JoinNames(capsules.unknown, ", ");
  }
  return text;
}

Json TouchesJson(const RetargetFigures& figures) {
  Json touches = Json::array();
  for (const TouchFigures& touch : figures.touches) {
    touches.push_back({{"first", touch.first},
                       {"second", touch.second},
                       {"depth_m", Number(touch.depth, 6)},
                       {"at_s", Number(touch.time)},
                       {"frames", Number(touch.share)},
                       {"by_inertia", touch.is_by_mass}});
  }
  return touches;
}

std::vector<LimbFigures> FarthestLimbs(const RetargetFigures& figures) {
  std::vector<LimbFigures> limbs = figures.limbs;
  std::stable_sort(limbs.begin(), limbs.end(), [](const LimbFigures& a, const LimbFigures& b) {
    return a.percentile95 > b.percentile95;
  });
  limbs.resize(std::min(limbs.size(), kLimbsShown));
  return limbs;
}

std::string DescribeLimbs(const RetargetFigures& figures) {
  std::string limbs;
  for (const LimbFigures& limb : FarthestLimbs(figures)) {
    limbs += fmt::format("; {} up to {:.0f} at {:.2f} s", limb.name, limb.most * kDegrees,
                         limb.most_time);
  }
  return fmt::format("{:.1f} degrees from the person's, 95 % below {:.1f}{}",
                     figures.direction * kDegrees, figures.direction95 * kDegrees, limbs);
}

Json LimbsJson(const RetargetFigures& figures) {
  Json limbs = Json::array();
  for (const LimbFigures& limb : figures.limbs) {
    limbs.push_back({{"name", limb.name},
                     {"mean_rad", Number(limb.mean)},
                     {"p95_rad", Number(limb.percentile95)},
                     {"most_rad", Number(limb.most)},
                     {"most_at_s", Number(limb.most_time)}});
  }
  return limbs;
}

std::string DescribeObjects(const RetargetReport& report) {
  std::string text =
      fmt::format("as large as {:.3f} times the recorded: ", report.retargeted.scale);
  std::vector<std::string> names;
  names.reserve(report.retargeted.objects.size());
  for (const TrackedObject& object : report.retargeted.objects) names.push_back(object.name);
  text += FirstNames(names);
  if (report.figures.holds.empty()) return text + "; the person takes none along";
  for (const HoldFigures& hold : report.figures.holds) {
    text += fmt::format(
        "; {} hand at {} from {:.2f} to {:.2f} s, {:.1f} mm off in the mean, {:.1f} at {:.2f} s",
        hold.hand, hold.object, hold.begin, hold.end, Millimetres(hold.mean),
        Millimetres(hold.most), hold.most_time);
  }
  return text;
}

Json ObjectsJson(const RetargetReport& report) {
  Json objects = Json::array();
  for (const TrackedObject& object : report.retargeted.objects) {
    Json holds = Json::array();
    for (const HoldFigures& hold : report.figures.holds) {
      if (hold.object != object.name) continue;
      holds.push_back({{"hand", hold.hand},
                       {"from_s", Number(hold.begin)},
                       {"to_s", Number(hold.end)},
                       {"off_mean_m", Number(hold.mean, 6)},
                       {"off_most_m", Number(hold.most, 6)},
                       {"off_most_at_s", Number(hold.most_time)}});
    }
    objects.push_back({{"name", object.name}, {"held", holds}});
  }
  return objects;
}

Json JointsJson(const RetargetFigures& figures) {
  Json joints = Json::array();
  for (const JointFigures& joint : figures.joints) {
    joints.push_back({{"name", joint.name},
                      {"at_position_limit", Number(joint.share_at_limit)},
                      {"at_velocity_limit", Number(joint.share_at_speed)}});
  }
  return joints;
}

Json WeightsJson(const AimWeights& weights) {
  return {{"feet", weights.feet},
          {"hands", weights.hands},
          {"trunk", weights.trunk},
          {"limbs", weights.limbs}};
}

Json FilesJson(const RetargetReport& report) {
  Json files = Json::array();
  for (const RateFit& fit : report.fits) {
    const RetargetFigures& figures = fit.figures;
    files.push_back({{"files", fit.files},
                     {"rate_hz", Number(fit.rate)},
                     {"frames", figures.num_frames},
                     {"slide", Number(figures.slide)},
                     {"penetration_m", Number(figures.penetration, 6)},
                     {"floating_m", Number(figures.floating, 6)},
                     {"direction_rad", Number(figures.direction)},
                     {"acceleration_rad_s2", Number(figures.acceleration)},
                     {"position_limits_broken", figures.position_breaks},
                     {"velocity_limits_broken", figures.velocity_breaks},
                     {"verdict", ToJson(fit.verdict)}});
  }
  return files;
}

std::string DescribeFit(const RateFit& fit) {
  const RetargetFigures& figures = fit.figures;
  std::string text = JoinNames(fit.files, ", ") + ": ";
  if (!std::isnan(figures.slide)) {
    text += fmt::format("feet slide in {:.1f} %, at most {:.1f} mm below the floor; ",
                        kPercent * figures.slide, kMillimetres * figures.penetration);
  }
  return text + fmt::format("{:.1f} degrees, {:.3g} rad/s^2; {}", figures.direction * kDegrees,
                            figures.acceleration, DescribeVerdict(fit.verdict));
}

}  // namespace

std::string FormatRetargetSummary(const RetargetReport& report) {
  const RetargetFigures& figures = report.figures;
  std::string text =
      RetargetLine("motion", fmt::format("{}: {}, {} frames at {:g} Hz", report.file,
                                         report.motion_name, figures.num_frames, figures.rate));
  if (report.conversion_verdict) {
    text += RetargetLine("conversion", DescribeVerdict(*report.conversion_verdict));
  }
  if (!report.unshown.empty()) {
    text += RetargetLine("not shown", report.unshown + ": the robot's are as a person's at rest");
  }
  text +=
      RetargetLine("robot", fmt::format("{} ({}), {} joints; {:.3f} times the person",
                                        report.robot.model.name(), report.robot_file,
                                        report.robot.model.num_joints(), report.retargeted.scale));
  if (report.body.feet) text += DescribeFeet(report);
  if (!std::isnan(figures.direction)) text += RetargetLine("limbs", DescribeLimbs(figures));
  text += RetargetLine("joints", fmt::format("{:.3g} rad/s^2 and {:.3g} rad/s^3 rms; limits of "
                                             "position broken {} times, of velocity {} times",
                                             figures.acceleration, figures.jerk,
                                             figures.position_breaks, figures.velocity_breaks));
  text += RetargetLine("itself", DescribeTouches(report));
  if (!report.retargeted.objects.empty()) text += RetargetLine("objects", DescribeObjects(report));
  if (!std::isnan(figures.path)) {
    text += RetargetLine("path", fmt::format("{:.3f} of what the legs allow", figures.path));
  }
  text += RetargetLine("written", JoinNames(report.written, ", "));
  for (const RateFit& fit : report.fits) {
    text += RetargetLine(fmt::format("at {:g} Hz", fit.rate), DescribeFit(fit));
  }
  return text + RetargetLine("verdict", DescribeVerdict(report.verdict));
}

Json ToJson(const RetargetReport& report) {
  const RetargetFigures& figures = report.figures;
  Json json = {{"input", report.file},
               {"motion", report.motion_name},
               {"robot", report.robot.model.name()},
               {"robot_file", report.robot_file},
               {"output", report.output},
               {"map", FormatBodyMap(report.robot.model, report.body.map)},
               {"sole", report.body.feet ? TextOrNull((*report.body.feet)[0].said) : Json()},
               {"weights", WeightsJson(report.body.weights)},
               {"scale", Number(report.retargeted.scale)},
               {"frames", figures.num_frames},
               {"rate_hz", Number(figures.rate)},
               {"stances", StancesJson(report.retargeted.contacts)},
               {"contact", Number(figures.contact_share)},
               {"slide", Number(figures.slide)},
               {"toe_slide_30_hz", Number(figures.toe_slide)},
               {"penetration_m", Number(figures.penetration, 6)},
               {"penetration_at_s", Number(figures.penetration_time)},
               {"body_penetration_m", Number(figures.body_depth, 6)},
               {"body_penetration_at_s", Number(figures.body_depth_time)},
               {"deepest_body", TextOrNull(figures.deepest_body)},
               {"floating_m", Number(figures.floating, 6)},
               {"highest_stance_m", Number(figures.highest_stance, 4)},
               {"belt_m_s", Number(report.retargeted.belt.norm())},
               {"position_limits_broken", figures.position_breaks},
               {"velocity_limits_broken", figures.velocity_breaks},
               {"acceleration_rad_s2", Number(figures.acceleration)},
               {"jerk_rad_s3", Number(figures.jerk)},
               {"largest_jump_rad", Number(figures.largest_jump)},
               {"direction_rad", Number(figures.direction)},
               {"direction_p95_rad", Number(figures.direction95)},
               {"mirrored", figures.is_mirrored},
               {"backwards", figures.is_backwards},
               {"path", Number(figures.path)},
               {"limbs", LimbsJson(figures)},
               {"joints_at_limits", JointsJson(figures)},
               {"objects", ObjectsJson(report)},
               {"self_contact", TouchesJson(figures)},
               {"pairs_watched", report.body.capsules.pairs.size()},
               {"size_not_known", report.body.capsules.unknown}};
  json["conversion_verdict"] =
      report.conversion_verdict ? ToJson(*report.conversion_verdict) : Json();
  json["files_at_other_rates"] = FilesJson(report);
  json["verdict"] = ToJson(report.verdict);
  json["not_shown"] = TextOrNull(report.unshown);
  json["warnings"] = report.warnings.texts();
  return json;
}

}  // namespace mmm_converter
