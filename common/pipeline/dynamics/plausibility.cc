// SPDX-License-Identifier: MIT
#include "common/pipeline/dynamics/plausibility.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/motion/ground_rules.h"
#include "common/support/advice.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

// Why forces, and all that is made of accelerations, say nothing; empty: they do.
std::string WhyNoForces(const MotionDynamics& dynamics) {
  const Differentiation& differentiation = dynamics.differentiation;
  if (differentiation.cutoff_lowered) {
    return fmt::format(
        "the rate shows nothing faster than {:.3g} Hz: accelerations are far too small where the "
        "body meets the ground",
        differentiation.cutoff);
  }
  if (differentiation.noise_force_rms > kMostNoise || differentiation.force_peak > kNoiseForce) {
    return fmt::format(
        "accelerations are noise: it makes some {:.2g} body weights (rms) of forces of up to "
        "{:.3g}; smooth the motion (convert -c s2kf_offline), or take a lower {}",
        differentiation.noise_force_rms, differentiation.force_peak, OptionText("low-pass"));
  }
  if (dynamics.settled_begin == dynamics.settled_end) {
    return fmt::format(
        "no frame is {:.2g} s, a period of the low-pass, away from both ends of the recording",
        1 / differentiation.cutoff);
  }
  return "";
}

DynamicsCheck NotJudged(const std::string& name, const std::string& expected,
                        const std::string& reason) {
  return {name, "-", expected, DynamicsJudgement::kNotJudged, reason};
}

DynamicsCheck Judged(const std::string& name, const std::string& measured,
                     const std::string& expected, bool is_plausible, const std::string& reason) {
  return {name, measured, expected,
          is_plausible ? DynamicsJudgement::kPlausible : DynamicsJudgement::kImplausible,
          is_plausible ? "" : reason};
}

DynamicsCheck CheckKinematics(const MotionDynamics& dynamics) {
  const double distance =
      std::max(dynamics.kinematics.marker_distance, dynamics.kinematics.segment_distance);
  return Judged("kinematics, Simbody's and ours", fmt::format("{:.1e} m apart", distance),
                fmt::format("at most {:.0e} m", kMostKinematicsError),
                distance <= kMostKinematicsError,
                "the two programs place the body differently: this is a fault of this program");
}

DynamicsCheck CheckMeanForce(const MotionDynamics& dynamics) {
  const double mean = VerticalForce(dynamics).mean();
  const double expected = ExpectedMeanForce(dynamics);
  return Judged("mean vertical force", fmt::format("{:.3f} body weights", mean),
                fmt::format("{:.3f} ± {:g}", expected, kMostMeanForceError),
                std::abs(mean - expected) <= kMostMeanForceError,
                "the accelerations do not add up to the velocities of the centre of mass");
}

// What is bad about a frame: a figure above the most that is allowed.
struct FrameCheck {
  std::string name;
  std::string frames;  // that count
  std::string reason;
  std::string unit;
  int digits;  // behind the point
  double most;
};

// At most kMostBadFrames of the frames that count may be bad.
template <typename Counts, typename Figure>
DynamicsCheck CheckFrames(const MotionDynamics& dynamics, const FrameCheck& check,
                          const std::string& why_no_forces, Counts counts, Figure figure) {
  const std::string expected = fmt::format("in at most {:.0f} %", 100 * kMostBadFrames);
  if (!why_no_forces.empty()) return NotJudged(check.name, expected, why_no_forces);
  int all = 0;
  int bad = 0;
  int worst = dynamics.settled_begin;
  for (int k = dynamics.settled_begin; k < dynamics.settled_end; ++k) {
    if (!counts(k)) continue;
    ++all;
    if (!(figure(k) > check.most)) continue;
    if (++bad == 1 || figure(k) > figure(worst)) worst = k;
  }
  if (all < kLeastOnGround * dynamics.rate) {
    return NotJudged(
        check.name, expected,
        fmt::format("{:.2f} s {}, the recording's ends left out; at least {:g} s are needed",
                    all / dynamics.rate, check.frames, kLeastOnGround));
  }
  const double share = static_cast<double>(bad) / all;
  return Judged(check.name,
                fmt::format("in {:.1f} % of {} frames {}", 100 * share, all, check.frames),
                expected, share <= kMostBadFrames,
                fmt::format("{}; worst at {:.2f} s, {:.{}f} {}", check.reason, dynamics.time(worst),
                            figure(worst), check.digits, check.unit));
}

void AddGroundChecks(const MotionDynamics& dynamics, const std::string& why_no_forces,
                     std::vector<DynamicsCheck>* checks) {
  const Eigen::Matrix3Xd forces = dynamics.residual_force / dynamics.body_weight();
  const auto add = [&](const FrameCheck& check, const auto& counts, const auto& figure) {
    checks->push_back(CheckFrames(dynamics, check, why_no_forces, counts, figure));
  };
  const auto on_ground = [&](int k) { return IsOnGround(dynamics, k); };
  add({"ground pulls", "on the ground", "the body would have to be held down", "body weights", 2,
       kForceTolerance},
      on_ground, [&](int k) { return -forces(2, k); });
  add({"feet would slide", "on the ground",
       fmt::format("friction of more than {:g} times the vertical force is asked for",
                   kMostFriction),
       "body weights more than that", 2, kForceTolerance},
      on_ground, [&](int k) {
        return forces.col(k).head<2>().norm() - kMostFriction * std::max(0.0, forces(2, k));
      });
  add({"body would tip over", "on the ground",
       fmt::format("the force acts more than {:.0f} mm outside of what touches the ground",
                   1000 * kMostOutsideSupport),
       "mm", 0, 1000 * kMostOutsideSupport},
      on_ground, [&](int k) { return 1000 * dynamics.outside_support[k]; });
  add(
      {"carried beside the ground", "that carry",
       fmt::format("the body's lowest point is more than {:.0f} mm above or below the ground: it "
                   "stands in the air, or not all on one level",
                   1000 * kMostUneven),
       "mm", 0, 1000 * kMostUneven},
      [&](int k) { return forces(2, k) > kCarryingForce; },
      [&](int k) { return 1000 * std::abs(dynamics.contact_heights.col(k).minCoeff()); });
}

// Standard deviation of the acceleration that a parabola has from noise of its points. Errors of
// neighbouring frames are alike, so that it is larger in truth.
double FallDeviation(const BallisticPhase& flight, double rate) {
  const int frames = flight.end - flight.begin;
  if (frames < 4) return std::numeric_limits<double>::infinity();
  const double seconds = (frames - 1) / rate;
  const double noise = flight.parabola_rms * std::sqrt(frames / (frames - 3.0));
  return 2 * std::sqrt(180.0 / frames) * noise / (seconds * seconds);
}

double FallError(const BallisticPhase& flight) {
  return (flight.acceleration - Eigen::Vector3d(0, 0, -kGravity)).norm();
}

// Two standard deviations of its noise excuse no error that is larger still: a flight that does
// not fall in a parabola at all has much of both.
DynamicsJudgement JudgeFall(const BallisticPhase& flight, double rate) {
  const double most = kMostFallError * kGravity;
  const double noise = 2 * FallDeviation(flight, rate);
  if (FallError(flight) > most + noise) return DynamicsJudgement::kImplausible;
  const bool is_plausible = FallError(flight) <= most && noise <= most;
  return is_plausible ? DynamicsJudgement::kPlausible : DynamicsJudgement::kNotJudged;
}

// Where the segments' shares nearly cancel, little is left that could be constant: between the two
// measures nothing is said.
DynamicsJudgement JudgeMomentum(const BallisticPhase& flight) {
  if (flight.AngularMomentumVariation() <= kMostMomentumVariation)
    return DynamicsJudgement::kPlausible;
  if (VariationOfSegments(flight) > kMostMomentumVariation) return DynamicsJudgement::kImplausible;
  return DynamicsJudgement::kNotJudged;
}

int Severity(DynamicsJudgement judgement) {
  switch (judgement) {
    case DynamicsJudgement::kImplausible:
      return 2;
    case DynamicsJudgement::kPlausible:
      return 1;
    case DynamicsJudgement::kNotJudged:
      return 0;
  }
  return 0;
}

// The flight that decides: the worst of the implausible ones, else of the plausible ones.
template <typename Judge, typename Error>
const BallisticPhase& Deciding(const std::vector<BallisticPhase>& flights, Judge judge,
                               Error error) {
  return *std::max_element(flights.begin(), flights.end(),
                           [&](const BallisticPhase& a, const BallisticPhase& b) {
                             const int left = Severity(judge(a));
                             const int right = Severity(judge(b));
                             return left == right ? error(a) < error(b) : left < right;
                           });
}

std::string Which(const MotionDynamics& dynamics, const BallisticPhase& flight) {
  if (dynamics.ballistic_phases.size() == 1) return "";
  return fmt::format(", flight at {:.2f} s", dynamics.time(flight.begin));
}

DynamicsCheck CheckFall(const MotionDynamics& dynamics) {
  const auto judge = [&](const BallisticPhase& f) { return JudgeFall(f, dynamics.rate); };
  const BallisticPhase& flight = Deciding(dynamics.ballistic_phases, judge, FallError);
  const Eigen::Vector3d& a = flight.acceleration;
  DynamicsCheck check = {
      "fall in flight",
      fmt::format("{:.2f} m/s², sideways {:.2f}{}", a.z(), a.head<2>().norm(),
                  Which(dynamics, flight)),
      fmt::format("-{:g} and 0, together ± {:.2f}", kGravity, kMostFallError * kGravity),
      judge(flight), ""};
  if (check.judgement == DynamicsJudgement::kImplausible) {
    check.reason = "nothing touches the ground, but the centre of mass does not fall freely";
  } else if (check.judgement == DynamicsJudgement::kNotJudged) {
    check.reason = fmt::format("the noise of the flight's points leaves ± {:.2f} m/s² open",
                               2 * FallDeviation(flight, dynamics.rate));
  }
  const std::vector<BallisticPhase>& flights = dynamics.ballistic_phases;
  const auto open = std::count_if(flights.begin(), flights.end(), [&](const BallisticPhase& f) {
    return judge(f) == DynamicsJudgement::kNotJudged;
  });
  if (open > 0 && flights.size() > 1) {
    if (!check.reason.empty()) check.reason += "; ";
    check.reason += fmt::format("{} of {} flights not judged, as noise leaves their fall open",
                                open, flights.size());
  }
  return check;
}

DynamicsCheck CheckMomentum(const MotionDynamics& dynamics) {
  const BallisticPhase& flight =
      Deciding(dynamics.ballistic_phases, JudgeMomentum,
               [](const BallisticPhase& f) { return f.AngularMomentumVariation(); });
  DynamicsCheck check = {"angular momentum in flight",
                         fmt::format("varies by {:.0f} % of its mean {:.2f} kg m²/s{}",
                                     100 * flight.AngularMomentumVariation(),
                                     flight.angular_momentum.norm(), Which(dynamics, flight)),
                         fmt::format("at most {:.0f} %", 100 * kMostMomentumVariation),
                         JudgeMomentum(flight), ""};
  if (check.judgement == DynamicsJudgement::kImplausible) {
    check.reason = "nothing touches the ground, but the body turns faster or slower";
  } else if (check.judgement == DynamicsJudgement::kNotJudged) {
    check.reason = fmt::format(
        "the parts of the body turn against each other, with little left over; it varies by {:.0f} "
        "% of what they have",
        100 * VariationOfSegments(flight));
  }
  return check;
}

std::string WhyNoFlight(const DynamicsOptions& options) {
  return fmt::format(
      "there is no flight: all points of the body higher than {:.0f} mm for {:g} s or more",
      1000 * kRestHeight, options.shortest_flight);
}

void AddFlightChecks(const MotionDynamics& dynamics, const std::string& why_no_forces,
                     std::vector<DynamicsCheck>* checks) {
  const bool flies = !dynamics.ballistic_phases.empty();
  if (flies && why_no_forces.empty()) {
    checks->push_back(CheckFall(dynamics));
    checks->push_back(CheckMomentum(dynamics));
    return;
  }
  const std::string reason = flies ? why_no_forces : WhyNoFlight(dynamics.options);
  checks->push_back(NotJudged("fall in flight", fmt::format("-{:g} m/s²", kGravity), reason));
  checks->push_back(NotJudged("angular momentum in flight", "constant", reason));
}

DynamicsCheck CheckTorque(const MotionDynamics& dynamics, const Plausibility& judged) {
  const char* name = "largest torque off the ground";
  const std::string expected = fmt::format("at most {:.0f} N m", kMostTorque * dynamics.mass);
  if (!judged.differentiation.empty()) return NotJudged(name, expected, judged.differentiation);
  if (judged.peaks.empty() || std::isnan(judged.peaks.front().torque)) {
    return NotJudged(name, expected, "the ground's force goes through every joint in all frames");
  }
  const JointPeak& peak = judged.peaks.front();
  return Judged(
      name, fmt::format("{:.1f} N m, {} at {:.2f} s", peak.torque, peak.joint, peak.torque_time),
      expected, peak.torque <= kMostTorque * dynamics.mass,
      fmt::format("no joint of a body has more than some {:g} N m for each kilogram", kMostTorque));
}

// Judges the joint that needs most of its motor's limit, where such limits are known.
DynamicsCheck CheckMotors(const KinematicModel& model, const Eigen::VectorXd& limits,
                          const Plausibility& judged) {
  const char* name = "motors off the ground";
  const std::string expected = "at most what they have";
  if (!judged.differentiation.empty()) return NotJudged(name, expected, judged.differentiation);
  const JointPeak* worst = nullptr;
  double most = 0, limit = 0;
  for (const JointPeak& peak : judged.peaks) {
    const double of_joint = limits[model.FindJoint(peak.joint)];
    if (!std::isfinite(of_joint) || !(peak.torque / of_joint >= most)) continue;
    worst = &peak;
    limit = of_joint;
    most = peak.torque / of_joint;
  }
  if (worst == nullptr) {
    return NotJudged(name, expected, "the ground's force goes through all of them in all frames");
  }
  const bool slides = model.joint(model.FindJoint(worst->joint)).type == JointType::kSliding;
  return Judged(name,
                fmt::format("{:.1f} of {:g} N{}, {} at {:.2f} s", worst->torque, limit,
                            slides ? "" : " m", worst->joint, worst->torque_time),
                expected, most <= 1, "the robot's file allows its motor no more");
}

// joints x contact bodies.
Eigen::MatrixXi ContactsBelow(const KinematicModel& model, const MotionDynamics& dynamics) {
  const auto num_bodies = static_cast<Eigen::Index>(dynamics.contact_bodies.size());
  Eigen::MatrixXi below = Eigen::MatrixXi::Zero(model.num_joints(), num_bodies);
  for (int j = 0; j < model.num_joints(); ++j) {
    for (Eigen::Index b = 0; b < num_bodies; ++b) {
      const std::vector<int>& segments = dynamics.contact_bodies[b].segments;
      below(j, b) = std::any_of(segments.begin(), segments.end(), [&](int segment) {
        return model.IsBelow(segment, model.joint_segment(j));
      });
    }
  }
  return below;
}

// Largest |.| of a row, NaN left out; NaN where there is nothing else.
std::pair<double, int> Peak(const Eigen::MatrixXd& values, Eigen::Index row) {
  std::pair<double, int> peak = {kNaN, 0};
  for (int k = 0; k < values.cols(); ++k) {
    const double value = std::abs(values(row, k));
    if (value >= peak.first || (std::isnan(peak.first) && !std::isnan(value))) peak = {value, k};
  }
  return peak;
}

void MeasureFreeJoints(const KinematicModel& model, const MotionDynamics& dynamics,
                       Plausibility* judged) {
  const Eigen::MatrixXi loaded = ContactsBelow(model, dynamics) * dynamics.contacts;
  judged->torques = (loaded.array() > 0).select(kNaN, dynamics.joint_torques);
  judged->powers = (loaded.array() > 0).select(kNaN, dynamics.joint_power);
  for (Eigen::MatrixXd* values : {&judged->torques, &judged->powers}) {
    values->leftCols(dynamics.settled_begin).setConstant(kNaN);
    values->rightCols(dynamics.num_frames() - dynamics.settled_end).setConstant(kNaN);
  }
  judged->peaks.reserve(dynamics.joint_names.size());
  for (Eigen::Index j = 0; j < loaded.rows(); ++j) {
    const auto [torque, torque_frame] = Peak(judged->torques, j);
    const auto [power, power_frame] = Peak(judged->powers, j);
    const auto free = static_cast<double>(judged->torques.row(j).array().isFinite().count());
    judged->peaks.push_back({dynamics.joint_names[j], torque, dynamics.time(torque_frame), power,
                             dynamics.time(power_frame), free / dynamics.num_frames()});
  }
  std::stable_sort(judged->peaks.begin(), judged->peaks.end(),
                   [](const JointPeak& a, const JointPeak& b) {
                     return a.torque > b.torque || (std::isnan(b.torque) && !std::isnan(a.torque));
                   });
}

}  // namespace

const char* Name(DynamicsJudgement judgement) {
  switch (judgement) {
    case DynamicsJudgement::kPlausible:
      return "plausible";
    case DynamicsJudgement::kImplausible:
      return "implausible";
    case DynamicsJudgement::kNotJudged:
      return "not judged";
  }
  return "";
}

Plausibility JudgeDynamics(const KinematicModel& model, const MotionDynamics& dynamics,
                           const Eigen::VectorXd& effort_limits) {
  Plausibility judged;
  judged.differentiation = WhyNoForces(dynamics);
  if (judged.differentiation.empty()) MeasureFreeJoints(model, dynamics, &judged);
  judged.checks = {CheckKinematics(dynamics), CheckMeanForce(dynamics)};
  AddGroundChecks(dynamics, judged.differentiation, &judged.checks);
  AddFlightChecks(dynamics, judged.differentiation, &judged.checks);
  judged.checks.push_back(CheckTorque(dynamics, judged));
  if (effort_limits.array().isFinite().any()) {
    judged.checks.push_back(CheckMotors(model, effort_limits, judged));
  }
  // The first two hold for every motion: alone, they say nothing of this one.
  for (std::size_t i = 0; i < judged.checks.size(); ++i) {
    const DynamicsJudgement judgement = judged.checks[i].judgement;
    if (i < 2 && judgement == DynamicsJudgement::kPlausible) continue;
    if (Severity(judgement) > Severity(judged.judgement)) judged.judgement = judgement;
  }
  return judged;
}

Eigen::VectorXd VerticalForce(const MotionDynamics& dynamics) {
  return dynamics.residual_force.row(2).transpose() / dynamics.body_weight();
}

double ExpectedMeanForce(const MotionDynamics& dynamics) {
  const Eigen::Index last = dynamics.num_frames() - 1;
  const double faster = dynamics.com_velocity(2, last) - dynamics.com_velocity(2, 0);
  return 1 + faster * dynamics.rate / static_cast<double>(last) / kGravity;
}

bool IsOnGround(const MotionDynamics& dynamics, int frame) {
  return (dynamics.contacts.col(frame).array() > 0).any();
}

double VariationOfSegments(const BallisticPhase& flight) {
  return flight.angular_momentum_rms / flight.segment_angular_momentum;
}

}  // namespace mmm_converter
