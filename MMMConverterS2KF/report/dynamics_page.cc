// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/report/dynamics_page.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "MMMConverterS2KF/report/html.h"
#include "MMMConverterS2KF/report/packed_array.h"
#include "MMMConverterS2KF/report/page_sources.h"

namespace mmm_converter {
namespace {

using Eigen::MatrixXd;

constexpr std::size_t kShownJoints = 8;  // as many as the page has colours

// Row by row: a whole series after the other.
Json Series(const MatrixXd& rows) { return ToJson(PackFloats(rows.transpose())); }

Json ContactsOfPage(const MotionDynamics& dynamics) {
  Json bodies = Json::array();
  for (std::size_t b = 0; b < dynamics.contact_bodies.size(); ++b) {
    const auto row = static_cast<Eigen::Index>(b);
    if ((dynamics.contacts.row(row).array() == 0).all()) continue;
    bodies.push_back({{"name", dynamics.contact_bodies[b].name},
                      {"touches", Series(dynamics.contacts.row(row).cast<double>())}});
  }
  return bodies;
}

// The joints with the largest torques, in the order of the figures.
Json JointsJson(const MotionDynamics& dynamics, const Plausibility& judged) {
  Json joints = Json::array();
  for (std::size_t i = 0; i < std::min(kShownJoints, judged.peaks.size()); ++i) {
    const std::string& name = judged.peaks[i].joint;
    if (std::isnan(judged.peaks[i].torque)) break;
    const auto row = std::find(dynamics.joint_names.begin(), dynamics.joint_names.end(), name) -
                     dynamics.joint_names.begin();
    joints.push_back({{"name", name},
                      {"torque", Series(judged.torques.row(row))},
                      {"power", Series(judged.powers.row(row))}});
  }
  return joints;
}

Json SeriesJson(const MotionDynamics& dynamics, const Plausibility& judged) {
  const Eigen::Matrix3Xd forces = dynamics.residual_force / dynamics.body_weight();
  return {{"frames", dynamics.num_frames()},
          {"rate", dynamics.rate},
          {"first_time", dynamics.first_time},
          {"vertical_force", Series(forces.row(2))},
          {"horizontal_force", Series(forces.topRows<2>().colwise().norm())},
          {"height", Series(dynamics.com.row(2))},
          {"acceleration", Series(dynamics.com_acceleration)},
          {"angular_momentum", Series(dynamics.angular_momentum)},
          {"outside_support", Series(dynamics.outside_support.transpose())},
          {"contacts", ContactsOfPage(dynamics)},
          {"joints", JointsJson(dynamics, judged)}};
}

}  // namespace

std::string FormatDynamicsPage(const std::string& title, const DynamicsReport& report) {
  const std::string data =
      DataBlock("figures", FormatJson(ToJson(report))) +
      DataBlock("series", FormatJsonLine(SeriesJson(report.dynamics, report.plausibility)));
  return FormatPage({.title = title,
                     .styles = DynamicsStyles(),
                     .content = DynamicsContent(),
                     .data = data,
                     .libraries = {{PlotLibrary(), PlotLibrarySha256()}},
                     .script = {DynamicsScript(), DynamicsScriptSha256()}});
}

}  // namespace mmm_converter
