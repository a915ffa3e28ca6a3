// SPDX-License-Identifier: MIT
#include "common/io/trajectory_csv.h"

#include <cmath>

#include "common/io/xml_text.h"
#include "common/math/rotation.h"

namespace mmm_converter {

namespace {

constexpr double kMillimetres = 1e3;
// Nanoseconds, 0.1 micrometres, 0.01 microradians, as in the motion files.
constexpr int kTimeDecimals = 9;
constexpr int kLengthDecimals = 4;
constexpr int kAngleDecimals = 8;

void AppendCell(double value, int decimals, std::string* out) {
  *out += ',';
  if (std::isfinite(value)) AppendDecimal(value, decimals, out);
}

template <typename Vector>
void AppendCells(const Vector& values, double factor, int decimals, std::string* out) {
  for (Eigen::Index i = 0; i < values.size(); ++i) AppendCell(factor * values[i], decimals, out);
}

// joint names hold no comma: they are XML node names that readers split at blanks.
std::string Header(const PoseTrajectory& trajectory) {
  std::string header = "time_s";
  const auto append = [&](const std::string& prefix, const std::vector<std::string>& root) {
    for (const std::string& name : root) header.append(",").append(prefix).append(name);
    for (const std::string& name : trajectory.joint_names) {
      header.append(",").append(prefix).append(name).append("_rad");
    }
  };
  append("", {"root_x_mm", "root_y_mm", "root_z_mm", "root_roll_rad", "root_pitch_rad",
              "root_yaw_rad"});
  if (trajectory.standard_deviations.size() > 0) {
    append("sd_", {"root_x_mm", "root_y_mm", "root_z_mm", "root_about_x_rad", "root_about_y_rad",
                   "root_about_z_rad"});
  }
  return header + "\n";
}

void AppendRows(const PoseTrajectory& trajectory, PieceWriter* pieces) {
  std::string* const csv = pieces->text();
  Eigen::Vector3d rpy = Eigen::Vector3d::Zero();
  for (int k = 0; k < trajectory.num_frames(); ++k) {
    const Posture& q = trajectory.postures[k];
    const Eigen::Vector3d principal = RpyFromRotation(q.orientation.toRotationMatrix());
    rpy = k == 0 ? principal : ContinuousRpy(principal, rpy);
    AppendDecimal(trajectory.time(k), kTimeDecimals, csv);
    AppendCells(q.position, kMillimetres, kLengthDecimals, csv);
    AppendCells(rpy, 1, kAngleDecimals, csv);
    AppendCells(q.joint_angles, 1, kAngleDecimals, csv);
    if (trajectory.standard_deviations.size() > 0) {
      const auto deviations = trajectory.standard_deviations.col(k);
      AppendCells(deviations.head<3>(), kMillimetres, kLengthDecimals, csv);
      AppendCells(deviations.tail(deviations.size() - 3), 1, kAngleDecimals, csv);
    }
    *csv += '\n';
    pieces->EndPart();
  }
}

}  // namespace

TextPieces FormatTrajectoryCsv(const PoseTrajectory& trajectory) {
  return [&trajectory](const TextSink& sink) {
    PieceWriter pieces(sink);
    *pieces.text() += Header(trajectory);
    AppendRows(trajectory, &pieces);
    pieces.Flush();
  };
}

}  // namespace mmm_converter
