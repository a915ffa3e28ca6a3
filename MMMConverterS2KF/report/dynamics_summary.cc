// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/report/dynamics_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "MMMConverterS2KF/report/ground_json.h"
#include "common/kinetics/joint_forces_table.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

constexpr std::size_t kDynamicsLineStart = 12;
constexpr std::size_t kShownPeaks = 8;

std::string DynamicsLine(const std::string& name, const std::string& text) {
  return fmt::format("{:<{}}{}\n", name, kDynamicsLineStart, text);
}

// Characters, not bytes: figures have signs such as ±.
std::size_t Width(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) >> 6) != 2; }));
}

std::string Padded(const std::string& text, std::size_t width) {
  return text + std::string(width - std::min(width, Width(text)), ' ');
}

/// Frames in which the body rests above the ground, and how far.
struct Raised {
  int frames = 0;
  double least = 0, most = 0;
};

Raised RaisedOf(const MotionDynamics& dynamics) {
  Raised found;
  for (const double height : dynamics.raised) {
    if (height <= 0) continue;
    found.least = found.frames == 0 ? height : std::min(found.least, height);
    found.most = std::max(found.most, height);
    ++found.frames;
  }
  return found;
}

std::string DescribeDifferentiation(const Differentiation& differentiation) {
  const std::string made =
      fmt::format("the ground's force is up to {:.3g} body weights (rms {:.2g} about its mean)",
                  differentiation.force_peak, differentiation.force_rms);
  if (differentiation.source == DerivativeSource::kMotion) return "those of the motion; " + made;
  if (differentiation.cutoff <= 0) return "differences of the motion as it is; " + made;
  return fmt::format(
      "differences after a low-pass at {:.3g} Hz{}; {}; without it up to {:.3g} (rms {:.2g})",
      differentiation.cutoff, differentiation.cutoff_lowered ? ", all that the rate allows" : "",
      made, differentiation.raw_force_peak, differentiation.raw_force_rms);
}

std::string DescribePersonOf(const Person& person) {
  if (person.height.value == 0) return person.height.source;
  return fmt::format("{:.3g} m ({}), {:.4g} kg ({})", person.height.value, person.height.source,
                     person.mass.value, person.mass.source);
}

std::string DescribeContacts(const MotionDynamics& dynamics, bool with_forces) {
  std::string text;
  int off_ground = 0;
  for (int k = 0; k < dynamics.num_frames(); ++k) off_ground += IsOnGround(dynamics, k) ? 0 : 1;
  const auto share = [&](Eigen::Index frames) {
    return 100 * static_cast<double>(frames) / dynamics.num_frames();
  };
  for (std::size_t b = 0; b < dynamics.contact_bodies.size(); ++b) {
    const auto row = static_cast<Eigen::Index>(b);
    const Eigen::Index frames = (dynamics.contacts.row(row).array() > 0).count();
    if (frames == 0) continue;
    text += fmt::format("{} {:.0f} %, ", dynamics.contact_bodies[b].name, share(frames));
  }
  return text +
         fmt::format(
             "nothing {:.0f} % of the time; the ground is assumed to be level, at {:.3f} m{}",
             share(off_ground), dynamics.ground_height,
             with_forces ? "" : " (--forces names what was measured)");
}

/// Empty: the ground is enough.
std::string DescribeRaised(const MotionDynamics& dynamics) {
  const auto [frames, least, most] = RaisedOf(dynamics);
  if (frames == 0) return "";
  return fmt::format(
      "in {:.0f} % of the time no part of the body is near the ground, but one rests: it is "
      "assumed "
      "to stand on something there, {:.2f} to {:.2f} m above the ground (stairs, a box, a bar)",
      100.0 * frames / dynamics.num_frames(), least, most);
}

std::string DescribeFlight(const MotionDynamics& dynamics, const BallisticPhase& flight) {
  return fmt::format(
      "{:.3f} to {:.3f} s (frames {} to {}): falls with {:.2f} m/s² (expected -{:g}), sideways "
      "{:.2f} (0); angular momentum {:.2f} kg m²/s, varies by {:.0f} % (0)",
      dynamics.time(flight.begin), dynamics.time(flight.end - 1), flight.begin, flight.end - 1,
      flight.acceleration.z(), kGravity, flight.acceleration.head<2>().norm(),
      flight.angular_momentum.norm(), 100 * flight.AngularMomentumVariation());
}

std::string FormatFigures(const MotionDynamics& dynamics, bool with_forces) {
  const Eigen::VectorXd height = dynamics.com.row(2);
  std::string text = DynamicsLine(
      "body", fmt::format("{:.4g} kg, weight {:.1f} N", dynamics.mass, dynamics.body_weight()));
  text += DynamicsLine("com",
                       fmt::format("height mean {:.3f} m, {:.3f} to {:.3f}; speed up to {:.2f} m/s",
                                   height.mean(), height.minCoeff(), height.maxCoeff(),
                                   dynamics.com_velocity.colwise().norm().maxCoeff()));
  text += DynamicsLine("contacts", DescribeContacts(dynamics, with_forces));
  const std::string raised = DescribeRaised(dynamics);
  if (!raised.empty()) text += DynamicsLine("support", raised);
  for (const BallisticPhase& flight : dynamics.ballistic_phases)
    text += DynamicsLine("flight", DescribeFlight(dynamics, flight));
  return text;
}

// Joints that the motion asks for something, the largest torque first.
std::string FormatPeaks(const Plausibility& judged) {
  if (!judged.differentiation.empty()) {
    return DynamicsLine("torques", "not shown: " + judged.differentiation);
  }
  std::string text = fmt::format("\n{:<18}{:>8}{:>9}{:>10}{:>9}{:>14}\n", "joint, off ground",
                                 "N m", "at s", "W", "at s", "% of frames");
  for (std::size_t i = 0; i < std::min(kShownPeaks, judged.peaks.size()); ++i) {
    const JointPeak& peak = judged.peaks[i];
    if (std::isnan(peak.torque)) break;
    text +=
        fmt::format("{:<18}{:>8.1f}{:>9.2f}{:>10.1f}{:>9.2f}{:>14.0f}\n", peak.joint, peak.torque,
                    peak.torque_time, peak.power, peak.power_time, 100 * peak.free_share);
  }
  return text +
         "Where something below a joint touches the ground, its torque can't be told from motion "
         "alone.\n";
}

// What is said of the torques already is not repeated.
std::string VerdictText(const DynamicsCheck& check, const Plausibility& judged) {
  if (check.reason.empty()) return Name(check.judgement);
  return fmt::format("{}: {}", Name(check.judgement),
                     check.reason == judged.differentiation ? "see torques" : check.reason);
}

std::string FormatChecks(const Plausibility& judged) {
  const std::vector<DynamicsCheck>& checks = judged.checks;
  std::size_t name = 5;
  std::size_t measured = 8;
  std::size_t expected = 8;
  for (const DynamicsCheck& check : checks) {
    name = std::max(name, Width(check.name));
    measured = std::max(measured, Width(check.measured));
    expected = std::max(expected, Width(check.expected));
  }
  const auto row = [&](const std::string& a, const std::string& b, const std::string& c,
                       const std::string& d) {
    return fmt::format("{}  {}  {}  {}\n", Padded(a, name), Padded(b, measured),
                       Padded(c, expected), d);
  };
  std::string text = "\n" + row("check", "measured", "expected", "verdict");
  for (const DynamicsCheck& check : checks) {
    text += row(check.name, check.measured, check.expected, VerdictText(check, judged));
  }
  return text + "\n";
}

std::vector<std::string> NamesOf(const std::vector<DynamicsCheck>& checks,
                                 DynamicsJudgement judgement) {
  std::vector<std::string> names;
  for (const DynamicsCheck& check : checks) {
    if (check.judgement == judgement) names.push_back(check.name);
  }
  return names;
}

// Six significant digits; JSON has no NaN.
Json Digits(double value) {
  if (!std::isfinite(value)) return nullptr;
  if (value == 0) return 0.0;
  const double unit = std::pow(10, std::floor(std::log10(std::abs(value))) - 5);
  return unit < 1 ? std::round(value / unit) / std::round(1 / unit)
                  : std::round(value / unit) * unit;
}

Json Vector(const Eigen::Vector3d& v) { return {Digits(v.x()), Digits(v.y()), Digits(v.z())}; }

Json DescribeMotion(const DynamicsReport& report) {
  const CheckedMotion& motion = report.motion;
  const bool is_scaled = motion.person.height.value > 0;
  return {
      {"file", motion.file},
      {"motion", motion.name},
      {"first_frame", motion.first_frame},
      {"frames", report.dynamics.num_frames()},
      {"rate_hz", Digits(report.dynamics.rate)},
      {"model", motion.model_file},
      {"person",
       {{"height_m", is_scaled ? Digits(motion.person.height.value) : nullptr},
        {"height_source", motion.person.height.source},
        {"mass_kg", is_scaled ? Digits(motion.person.mass.value) : nullptr},
        {"mass_source", motion.person.mass.source},
        {"subject", motion.person.subject ? Json(motion.person.subject->name) : Json(nullptr)}}}};
}

Json DifferentiationJson(const Differentiation& differentiation) {
  const bool of_motion = differentiation.source == DerivativeSource::kMotion;
  return {{"source", of_motion ? "motion" : "differences"},
          {"low_pass_hz", differentiation.cutoff > 0 ? Digits(differentiation.cutoff) : nullptr},
          {"low_pass_lowered", differentiation.cutoff_lowered},
          {"force_rms_body_weights", Digits(differentiation.force_rms)},
          {"force_peak_body_weights", Digits(differentiation.force_peak)},
          {"noise_force_rms_body_weights", Digits(differentiation.noise_force_rms)},
          {"unfiltered_force_rms_body_weights", Digits(differentiation.raw_force_rms)},
          {"unfiltered_force_peak_body_weights", Digits(differentiation.raw_force_peak)}};
}

Json DescribeCenterOfMass(const MotionDynamics& dynamics) {
  const Eigen::VectorXd height = dynamics.com.row(2);
  return {{"height_m",
           {{"mean", Digits(height.mean())},
            {"min", Digits(height.minCoeff())},
            {"max", Digits(height.maxCoeff())}}},
          {"largest_speed_m_per_s", Digits(dynamics.com_velocity.colwise().norm().maxCoeff())}};
}

// The longest vector of the settled frames; NaN where there is none.
double Largest(const MotionDynamics& dynamics, const Eigen::Matrix3Xd& vectors) {
  const int frames = dynamics.settled_end - dynamics.settled_begin;
  if (frames == 0) return std::nan("");
  return vectors.middleCols(dynamics.settled_begin, frames).colwise().norm().maxCoeff();
}

Json DescribeForces(const MotionDynamics& dynamics) {
  const Eigen::VectorXd all_vertical = VerticalForce(dynamics);
  const int frames = dynamics.settled_end - dynamics.settled_begin;
  const Eigen::VectorXd vertical = all_vertical.segment(dynamics.settled_begin, frames);
  const double weight = dynamics.body_weight();
  const double force = Largest(dynamics, dynamics.residual_force);
  const double root_moment = Largest(dynamics, dynamics.residual_root_moment);
  const double moment = Largest(dynamics, dynamics.residual_moment);
  return {{"body_weight_n", Digits(weight)},
          {"vertical_body_weights",
           {{"mean", Digits(all_vertical.mean())},
            {"expected_mean", Digits(ExpectedMeanForce(dynamics))},
            {"min", frames == 0 ? nullptr : Digits(vertical.minCoeff())},
            {"max", frames == 0 ? nullptr : Digits(vertical.maxCoeff())}}},
          {"largest_residual_force_n", Digits(force)},
          {"largest_residual_force_body_weights", Digits(force / weight)},
          {"largest_residual_root_moment_nm", Digits(root_moment)},
          {"largest_residual_root_moment_body_weight_metres", Digits(root_moment / weight)},
          {"largest_residual_moment_nm", Digits(moment)},
          {"largest_residual_moment_body_weight_metres", Digits(moment / weight)}};
}

Json ContactsJson(const MotionDynamics& dynamics) {
  Json contacts = Json::array();
  for (std::size_t b = 0; b < dynamics.contact_bodies.size(); ++b) {
    const auto row = static_cast<Eigen::Index>(b);
    const auto frames = static_cast<double>((dynamics.contacts.row(row).array() > 0).count());
    contacts.push_back({{"body", dynamics.contact_bodies[b].name},
                        {"share", Digits(frames / dynamics.num_frames())},
                        {"lowest_m", Digits(dynamics.contact_heights.row(row).minCoeff())}});
  }
  return contacts;
}

Json DescribeFlights(const MotionDynamics& dynamics) {
  Json flights = Json::array();
  for (const BallisticPhase& flight : dynamics.ballistic_phases) {
    flights.push_back(
        {{"first_frame", flight.begin},
         {"last_frame", flight.end - 1},
         {"first_s", Digits(dynamics.time(flight.begin))},
         {"last_s", Digits(dynamics.time(flight.end - 1))},
         {"acceleration_m_per_s2", Vector(flight.acceleration)},
         {"expected_m_per_s2", Vector({0, 0, -kGravity})},
         {"parabola_rms_m", Digits(flight.parabola_rms)},
         {"differentiated_acceleration_m_per_s2", Vector(flight.mean_acceleration)},
         {"mean_force_body_weights", Digits(flight.mean_force)},
         {"angular_momentum_kg_m2_per_s", Vector(flight.angular_momentum)},
         {"angular_momentum_variation", Digits(flight.AngularMomentumVariation())},
         {"angular_momentum_variation_of_segments", Digits(VariationOfSegments(flight))},
         {"angular_momentum_largest_deviation_kg_m2_per_s", Digits(flight.angular_momentum_max)}});
  }
  return flights;
}

Json DescribePeaks(const std::vector<JointPeak>& peaks) {
  Json joints = Json::array();
  for (const JointPeak& peak : peaks) {
    joints.push_back({{"joint", peak.joint},
                      {"torque_nm", Digits(peak.torque)},
                      {"torque_s", Digits(peak.torque_time)},
                      {"power_w", Digits(peak.power)},
                      {"power_s", Digits(peak.power_time)},
                      {"share_off_ground", Digits(peak.free_share)}});
  }
  return joints;
}

Json DescribeChecks(const std::vector<DynamicsCheck>& checks) {
  Json list = Json::array();
  for (const DynamicsCheck& check : checks) {
    list.push_back({{"check", check.name},
                    {"measured", check.measured},
                    {"expected", check.expected},
                    {"verdict", Name(check.judgement)},
                    {"reason", TextOrNull(check.reason)}});
  }
  return list;
}

}  // namespace

std::string DynamicsSentence(const DynamicsReport& report) {
  const std::vector<DynamicsCheck>& checks = report.plausibility.checks;
  const std::string& file = report.motion.file;
  const auto implausible = NamesOf(checks, DynamicsJudgement::kImplausible);
  const auto plausible = NamesOf(checks, DynamicsJudgement::kPlausible);
  const std::size_t open = checks.size() - implausible.size() - plausible.size();
  switch (report.plausibility.judgement) {
    case DynamicsJudgement::kImplausible:
      return fmt::format("{} is implausible: {} ({} of {} checks are plausible, {} not judged).",
                         file, JoinNames(implausible, " and "), plausible.size(), checks.size(),
                         open);
    case DynamicsJudgement::kPlausible:
      return fmt::format(
          "{} is plausible: a body can move like that ({} of {} checks, {} not "
          "judged).",
          file, plausible.size(), checks.size(), open);
    case DynamicsJudgement::kNotJudged:
      return fmt::format("{} is not judged: {}.", file,
                         report.plausibility.differentiation.empty()
                             ? "no check has enough to go by"
                             : report.plausibility.differentiation);
  }
  return "";
}

std::string FormatDynamicsSummary(const DynamicsReport& report) {
  const CheckedMotion& motion = report.motion;
  const MotionDynamics& dynamics = report.dynamics;
  std::string text =
      DynamicsLine("motion", fmt::format("{}: \"{}\", {} frames at {:.6g} Hz ({:.3f} s)",
                                         motion.file, motion.name, dynamics.num_frames(),
                                         dynamics.rate, dynamics.num_frames() / dynamics.rate));
  text += DynamicsLine("person", DescribePersonOf(motion.person));
  text += DynamicsLine("model", motion.model_file);
  text += DynamicsLine("derivatives", DescribeDifferentiation(dynamics.differentiation));
  text += FormatFigures(dynamics, report.with_forces.has_value());
  if (report.with_forces) {
    text += DynamicsLine("forces",
                         SentenceOf(MeasureResiduals(*report.with_forces), *report.with_forces));
  }
  text += FormatPeaks(report.plausibility);
  return text + FormatChecks(report.plausibility) + DynamicsSentence(report) + "\n";
}

Json ToJson(const DynamicsReport& report) {
  const MotionDynamics& dynamics = report.dynamics;
  const Plausibility& judged = report.plausibility;
  const KinematicsAgreement& kinematics = dynamics.kinematics;
  return {
      {"program", "MMMConverterS2KF " MMM_CONVERTER_VERSION},
      {"input", DescribeMotion(report)},
      {"kinematics",
       {{"marker_distance_m", Digits(kinematics.marker_distance)},
        {"segment_distance_m", Digits(kinematics.segment_distance)},
        {"segment_angle_rad", Digits(kinematics.segment_angle)}}},
      {"derivatives", DifferentiationJson(dynamics.differentiation)},
      {"mass_kg", Digits(dynamics.mass)},
      {"center_of_mass", DescribeCenterOfMass(dynamics)},
      {"forces", DescribeForces(dynamics)},
      {"ground_m", Digits(dynamics.ground_height)},
      {"raised_m", Digits(dynamics.raised.size() > 0 ? dynamics.raised.maxCoeff() : 0)},
      {"contacts", ContactsJson(dynamics)},
      {"stances", StancesJson(dynamics.feet)},
      {"flights", DescribeFlights(dynamics)},
      {"with_forces", report.with_forces ? Json::parse(FormatJointForcesJson(*report.with_forces))
                                         : Json(nullptr)},
      {"joints", DescribePeaks(judged.peaks)},
      {"checks", DescribeChecks(judged.checks)},
      {"verdict", Name(judged.judgement)},
      {"sentence", DynamicsSentence(report)},
      {"warnings", report.motion.warnings.texts()}};
}

}  // namespace mmm_converter
