// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/report/dynamics_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

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

}  // namespace mmm_converter
