// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/dynamics/plausibility.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace mmm_converter {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// Why forces, and all that is made of accelerations, say nothing; empty: they do.
std::string WhyNoForces(const Differentiation& differentiation) {
  if (differentiation.cutoff_lowered) {
    return fmt::format(
        "the rate shows nothing faster than {:.3g} Hz: accelerations are far too small where the "
        "body meets the ground",
        differentiation.cutoff);
  }
  if (differentiation.force_peak > kNoiseForce) {
    return fmt::format(
        "accelerations are noise: they ask for up to {:.3g} body weights; smooth the motion "
        "(convert -c s2kf_offline), or take a lower --low-pass",
        differentiation.force_peak);
  }
  return "";
}

DynamicsCheck NotJudged(const std::string& name, const std::string& expected,
                        const std::string& reason) {
  return {name, "-", expected, Judgement::kNotJudged, reason};
}

DynamicsCheck Judged(const std::string& name, const std::string& measured,
                     const std::string& expected, bool is_plausible, const std::string& reason) {
  return {name, measured, expected, is_plausible ? Judgement::kPlausible : Judgement::kImplausible,
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

// A share of the frames on the ground that are bad in some way.
struct BadFrames {
  int bad = 0;
  int all = 0;
  double share() const { return all == 0 ? 0 : static_cast<double>(bad) / all; }
};

template <typename Predicate>
BadFrames CountOnGround(const MotionDynamics& dynamics, Predicate is_bad) {
  BadFrames count;
  for (int k = 0; k < dynamics.num_frames(); ++k) {
    if (!IsOnGround(dynamics, k)) continue;
    ++count.all;
    if (is_bad(k)) ++count.bad;
  }
  return count;
}

template <typename Predicate>
DynamicsCheck CheckOnGround(const MotionDynamics& dynamics, const std::string& name,
                            const std::string& reason, const std::string& why_no_forces,
                            Predicate is_bad) {
  const std::string expected = fmt::format("in at most {:.0f} %", 100 * kMostBadFrames);
  if (!why_no_forces.empty()) return NotJudged(name, expected, why_no_forces);
  const BadFrames count = CountOnGround(dynamics, is_bad);
  if (count.all == 0) return NotJudged(name, expected, "nothing touches the ground");
  return Judged(name, fmt::format("in {:.1f} % of {} frames on it", 100 * count.share(), count.all),
                expected, count.share() <= kMostBadFrames, reason);
}

void AddGroundChecks(const MotionDynamics& dynamics, const std::string& why_no_forces,
                     std::vector<DynamicsCheck>* checks) {
  const Eigen::Matrix3Xd forces = dynamics.residual_force / dynamics.body_weight();
  checks->push_back(CheckOnGround(dynamics, "ground pulls", "the body would have to be held down",
                                  why_no_forces,
                                  [&](int k) { return forces(2, k) < -kForceTolerance; }));
  checks->push_back(
      CheckOnGround(dynamics, "feet would slide",
                    fmt::format("friction of more than {:g} times the vertical force is asked for",
                                kMostFriction),
                    why_no_forces, [&](int k) {
                      return forces.col(k).head<2>().norm() >
                             kMostFriction * std::max(0.0, forces(2, k)) + kForceTolerance;
                    }));
  checks->push_back(CheckOnGround(
      dynamics, "body would tip over",
      fmt::format("the force acts more than {:.0f} mm outside of what touches the ground",
                  1000 * kMostOutsideSupport),
      why_no_forces, [&](int k) { return dynamics.outside_support[k] > kMostOutsideSupport; }));
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

Judgement JudgeFall(const BallisticPhase& flight, double rate) {
  const double most = kMostFallError * kGravity;
  if (2 * FallDeviation(flight, rate) > most) return Judgement::kNotJudged;
  return FallError(flight) <= most ? Judgement::kPlausible : Judgement::kImplausible;
}

// Where the segments' shares nearly cancel, little is left that could be constant: between the two
// measures nothing is said.
Judgement JudgeMomentum(const BallisticPhase& flight) {
  if (flight.AngularMomentumVariation() <= kMostMomentumVariation) return Judgement::kPlausible;
  if (VariationOfSegments(flight) > kMostMomentumVariation) return Judgement::kImplausible;
  return Judgement::kNotJudged;
}

int Severity(Judgement judgement) {
  switch (judgement) {
    case Judgement::kImplausible:
      return 2;
    case Judgement::kPlausible:
      return 1;
    case Judgement::kNotJudged:
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
  if (check.judgement == Judgement::kImplausible) {
    check.reason = "nothing touches the ground, but the centre of mass does not fall freely";
  } else if (check.judgement == Judgement::kNotJudged) {
    check.reason = fmt::format("the flight is too short: noise alone makes ± {:.2f} m/s²",
                               2 * FallDeviation(flight, dynamics.rate));
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
  if (check.judgement == Judgement::kImplausible) {
    check.reason = "nothing touches the ground, but the body turns faster or slower";
  } else if (check.judgement == Judgement::kNotJudged) {
    check.reason = fmt::format(
        "the parts of the body turn against each other, with little left over; it varies by {:.0f} "
        "% of what they have",
        100 * VariationOfSegments(flight));
  }
  return check;
}

void AddFlightChecks(const MotionDynamics& dynamics, const std::string& why_no_forces,
                     std::vector<DynamicsCheck>* checks) {
  const bool flies = !dynamics.ballistic_phases.empty();
  if (flies && why_no_forces.empty()) {
    checks->push_back(CheckFall(dynamics));
    checks->push_back(CheckMomentum(dynamics));
    return;
  }
  const std::string reason = flies ? why_no_forces : "the body never leaves the ground";
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

// Whether the segment lies below the joint, or is its own.
bool IsBelow(const KinematicModel& model, int segment, int joint_segment) {
  while (segment > joint_segment) segment = model.segments()[segment].parent;
  return segment == joint_segment;
}

// joints x contact bodies.
Eigen::MatrixXi ContactsBelow(const KinematicModel& model, const MotionDynamics& dynamics) {
  const auto num_bodies = static_cast<Eigen::Index>(dynamics.contact_bodies.size());
  Eigen::MatrixXi below = Eigen::MatrixXi::Zero(model.num_joints(), num_bodies);
  for (int j = 0; j < model.num_joints(); ++j) {
    for (Eigen::Index b = 0; b < num_bodies; ++b) {
      const std::vector<int>& segments = dynamics.contact_bodies[b].segments;
      below(j, b) = std::any_of(segments.begin(), segments.end(), [&](int segment) {
        return IsBelow(model, segment, model.joint_segment(j));
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

void TakeFreeJoints(const KinematicModel& model, const MotionDynamics& dynamics,
                    Plausibility* judged) {
  const Eigen::MatrixXi loaded = ContactsBelow(model, dynamics) * dynamics.contacts;
  judged->torques = (loaded.array() > 0).select(kNaN, dynamics.joint_torques);
  judged->powers = (loaded.array() > 0).select(kNaN, dynamics.joint_power);
  judged->peaks.reserve(dynamics.joint_names.size());
  for (Eigen::Index j = 0; j < loaded.rows(); ++j) {
    const auto [torque, torque_frame] = Peak(judged->torques, j);
    const auto [power, power_frame] = Peak(judged->powers, j);
    const auto free = static_cast<double>((loaded.row(j).array() == 0).count());
    judged->peaks.push_back({dynamics.joint_names[j], torque, dynamics.time(torque_frame), power,
                             dynamics.time(power_frame), free / dynamics.num_frames()});
  }
  std::stable_sort(judged->peaks.begin(), judged->peaks.end(),
                   [](const JointPeak& a, const JointPeak& b) {
                     return a.torque > b.torque || (std::isnan(b.torque) && !std::isnan(a.torque));
                   });
}

}  // namespace

const char* Name(Judgement judgement) {
  switch (judgement) {
    case Judgement::kPlausible:
      return "plausible";
    case Judgement::kImplausible:
      return "implausible";
    case Judgement::kNotJudged:
      return "not judged";
  }
  return "";
}

Plausibility JudgeDynamics(const KinematicModel& model, const MotionDynamics& dynamics) {
  Plausibility judged;
  judged.differentiation = WhyNoForces(dynamics.differentiation);
  if (judged.differentiation.empty()) TakeFreeJoints(model, dynamics, &judged);
  judged.checks = {CheckKinematics(dynamics), CheckMeanForce(dynamics)};
  AddGroundChecks(dynamics, judged.differentiation, &judged.checks);
  AddFlightChecks(dynamics, judged.differentiation, &judged.checks);
  judged.checks.push_back(CheckTorque(dynamics, judged));
  // The first two hold for every motion: alone, they say nothing of this one.
  for (std::size_t i = 0; i < judged.checks.size(); ++i) {
    const Judgement judgement = judged.checks[i].judgement;
    if (i < 2 && judgement == Judgement::kPlausible) continue;
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
