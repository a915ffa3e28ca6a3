// SPDX-License-Identifier: MIT
#include <cmath>
#include <nlohmann/json.hpp>

#include "MMMConverterS2KF/report/dynamics_summary.h"
#include "MMMConverterS2KF/report/ground_json.h"
#include "common/kinetics/joint_forces_table.h"

namespace mmm_converter {
namespace {

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
