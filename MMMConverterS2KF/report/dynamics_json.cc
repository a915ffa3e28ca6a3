// SPDX-License-Identifier: MIT
#include <cmath>
#include <nlohmann/json.hpp>

#include "MMMConverterS2KF/report/dynamics_summary.h"

namespace mmm_converter {
namespace {

using Json = nlohmann::ordered_json;

// Six significant digits; JSON has no NaN.
Json Number(double value) {
  if (!std::isfinite(value)) return nullptr;
  if (value == 0) return 0.0;
  const double unit = std::pow(10, std::floor(std::log10(std::abs(value))) - 5);
  return unit < 1 ? std::round(value / unit) / std::round(1 / unit)
                  : std::round(value / unit) * unit;
}

Json Vector(const Eigen::Vector3d& v) { return {Number(v.x()), Number(v.y()), Number(v.z())}; }

Json DescribeMotion(const DynamicsReport& report) {
  const CheckedMotion& motion = report.motion;
  const bool is_scaled = motion.person.height.value > 0;
  return {
      {"file", motion.file},
      {"motion", motion.name},
      {"first_frame", motion.first_frame},
      {"frames", report.dynamics.num_frames()},
      {"rate_hz", Number(report.dynamics.rate)},
      {"model", motion.model_file},
      {"person",
       {{"height_m", is_scaled ? Number(motion.person.height.value) : nullptr},
        {"height_source", motion.person.height.source},
        {"mass_kg", is_scaled ? Number(motion.person.mass.value) : nullptr},
        {"mass_source", motion.person.mass.source},
        {"subject", motion.person.subject ? Json(motion.person.subject->name) : Json(nullptr)}}}};
}

Json DescribeDifferentiation(const Differentiation& differentiation) {
  const bool of_motion = differentiation.source == DerivativeSource::kMotion;
  return {{"source", of_motion ? "motion" : "differences"},
          {"low_pass_hz", differentiation.cutoff > 0 ? Number(differentiation.cutoff) : nullptr},
          {"low_pass_lowered", differentiation.cutoff_lowered},
          {"force_rms_body_weights", Number(differentiation.force_rms)},
          {"force_peak_body_weights", Number(differentiation.force_peak)},
          {"noise_force_rms_body_weights", Number(differentiation.noise_force_rms)},
          {"unfiltered_force_rms_body_weights", Number(differentiation.raw_force_rms)},
          {"unfiltered_force_peak_body_weights", Number(differentiation.raw_force_peak)}};
}

Json DescribeCenterOfMass(const MotionDynamics& dynamics) {
  const Eigen::VectorXd height = dynamics.com.row(2);
  return {{"height_m",
           {{"mean", Number(height.mean())},
            {"min", Number(height.minCoeff())},
            {"max", Number(height.maxCoeff())}}},
          {"largest_speed_m_per_s", Number(dynamics.com_velocity.colwise().norm().maxCoeff())}};
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
  return {{"body_weight_n", Number(weight)},
          {"vertical_body_weights",
           {{"mean", Number(all_vertical.mean())},
            {"expected_mean", Number(ExpectedMeanForce(dynamics))},
            {"min", frames == 0 ? nullptr : Number(vertical.minCoeff())},
            {"max", frames == 0 ? nullptr : Number(vertical.maxCoeff())}}},
          {"largest_residual_force_n", Number(force)},
          {"largest_residual_force_body_weights", Number(force / weight)},
          {"largest_residual_root_moment_nm", Number(root_moment)},
          {"largest_residual_root_moment_body_weight_metres", Number(root_moment / weight)},
          {"largest_residual_moment_nm", Number(moment)},
          {"largest_residual_moment_body_weight_metres", Number(moment / weight)}};
}

Json DescribeContacts(const MotionDynamics& dynamics) {
  Json contacts = Json::array();
  for (std::size_t b = 0; b < dynamics.contact_bodies.size(); ++b) {
    const auto row = static_cast<Eigen::Index>(b);
    const auto frames = static_cast<double>((dynamics.contacts.row(row).array() > 0).count());
    contacts.push_back({{"body", dynamics.contact_bodies[b].name},
                        {"share", Number(frames / dynamics.num_frames())},
                        {"lowest_m", Number(dynamics.contact_heights.row(row).minCoeff())}});
  }
  return contacts;
}

Json DescribeFlights(const MotionDynamics& dynamics) {
  Json flights = Json::array();
  for (const BallisticPhase& flight : dynamics.ballistic_phases) {
    flights.push_back(
        {{"first_frame", flight.begin},
         {"last_frame", flight.end - 1},
         {"first_s", Number(dynamics.time(flight.begin))},
         {"last_s", Number(dynamics.time(flight.end - 1))},
         {"acceleration_m_per_s2", Vector(flight.acceleration)},
         {"expected_m_per_s2", Vector({0, 0, -kGravity})},
         {"parabola_rms_m", Number(flight.parabola_rms)},
         {"differentiated_acceleration_m_per_s2", Vector(flight.mean_acceleration)},
         {"mean_force_body_weights", Number(flight.mean_force)},
         {"angular_momentum_kg_m2_per_s", Vector(flight.angular_momentum)},
         {"angular_momentum_variation", Number(flight.AngularMomentumVariation())},
         {"angular_momentum_variation_of_segments", Number(VariationOfSegments(flight))},
         {"angular_momentum_largest_deviation_kg_m2_per_s", Number(flight.angular_momentum_max)}});
  }
  return flights;
}

Json DescribePeaks(const std::vector<JointPeak>& peaks) {
  Json joints = Json::array();
  for (const JointPeak& peak : peaks) {
    joints.push_back({{"joint", peak.joint},
                      {"torque_nm", Number(peak.torque)},
                      {"torque_s", Number(peak.torque_time)},
                      {"power_w", Number(peak.power)},
                      {"power_s", Number(peak.power_time)},
                      {"share_off_ground", Number(peak.free_share)}});
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
                    {"reason", check.reason.empty() ? Json(nullptr) : Json(check.reason)}});
  }
  return list;
}

}  // namespace

std::string FormatDynamicsJson(const DynamicsReport& report) {
  const MotionDynamics& dynamics = report.dynamics;
  const Plausibility& judged = report.plausibility;
  const KinematicsAgreement& kinematics = dynamics.kinematics;
  const Json json = {{"program", "MMMConverterS2KF " MMM_CONVERTER_VERSION},
                     {"input", DescribeMotion(report)},
                     {"kinematics",
                      {{"marker_distance_m", Number(kinematics.marker_distance)},
                       {"segment_distance_m", Number(kinematics.segment_distance)},
                       {"segment_angle_rad", Number(kinematics.segment_angle)}}},
                     {"derivatives", DescribeDifferentiation(dynamics.differentiation)},
                     {"mass_kg", Number(dynamics.mass)},
                     {"center_of_mass", DescribeCenterOfMass(dynamics)},
                     {"forces", DescribeForces(dynamics)},
                     {"ground_m", Number(dynamics.ground_height)},
                     {"contacts", DescribeContacts(dynamics)},
                     {"flights", DescribeFlights(dynamics)},
                     {"joints", DescribePeaks(judged.peaks)},
                     {"checks", DescribeChecks(judged.checks)},
                     {"verdict", Name(judged.judgement)},
                     {"sentence", DynamicsSentence(report)},
                     {"warnings", report.motion.warnings.texts()}};
  // File names may hold bytes that are no UTF-8.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace mmm_converter
