// SPDX-License-Identifier: MIT
#include "common/io/tables/trajectory_csv.h"

#include <cmath>

#include "common/io/tables/column_names.h"
#include "common/io/xml/xml_text.h"
#include "common/math/rotation.h"
#include "common/support/units.h"

namespace mmm_converter {

namespace {

// Nanoseconds, 0.1 micrometres, 0.01 microradians, as in the motion files.

void AppendCell(double value, int decimals, std::string* out) {
  *out += ',';
  if (std::isfinite(value)) AppendDecimal(value, decimals, out);
}

template <typename Vector>
void AppendCells(const Vector& values, double factor, int decimals, std::string* out) {
  for (Eigen::Index i = 0; i < values.size(); ++i) AppendCell(factor * values[i], decimals, out);
}

std::string CsvHeader(const PoseTrajectory& trajectory) {
  const std::vector<std::string> joints = CsvColumnNames(trajectory.joint_names);
  std::string header = "time_s";
  const auto append = [&](const std::string& prefix, const std::vector<std::string>& turns,
                          const std::string& per) {
    for (const char* axis : {"x", "y", "z"}) {
      header.append(",").append(prefix).append("root_").append(axis).append("_mm").append(per);
    }
    for (const std::string& turn : turns) {
      header.append(",").append(prefix).append("root_").append(turn).append("_rad").append(per);
    }
    for (const std::string& name : joints) {
      header.append(",").append(prefix).append(name).append("_rad").append(per);
    }
  };
  const std::vector<std::string> axes = {"about_x", "about_y", "about_z"};
  append("", {"roll", "pitch", "yaw"}, "");
  if (trajectory.standard_deviations.size() > 0) append("sd_", axes, "");
  if (trajectory.velocities.size() > 0) append("d_", axes, "_per_s");
  if (trajectory.accelerations.size() > 0) append("dd_", axes, "_per_s2");
  return header + "\n";
}

void AppendCsvRows(const PoseTrajectory& trajectory, PieceWriter* pieces) {
  std::string* const csv = pieces->text();
  Eigen::Vector3d rpy = Eigen::Vector3d::Zero();
  for (int k = 0; k < trajectory.num_frames(); ++k) {
    const Posture& q = trajectory.postures[k];
    const Eigen::Vector3d principal = RpyFromRotation(q.orientation.toRotationMatrix());
    rpy = k == 0 ? principal : ContinuousRpy(principal, rpy);
    AppendDecimal(trajectory.time(k), kSecondDecimals, csv);
    AppendCells(q.position, kMillimetres, kMillimetreDecimals, csv);
    AppendCells(rpy, 1, kRadianDecimals, csv);
    AppendCells(q.joint_angles, 1, kRadianDecimals, csv);
    for (const Eigen::MatrixXd* values :
         {&trajectory.standard_deviations, &trajectory.velocities, &trajectory.accelerations}) {
      if (values->size() == 0) continue;
      AppendCells(values->col(k).head<3>(), kMillimetres, kMillimetreDecimals, csv);
      AppendCells(values->col(k).tail(values->rows() - 3), 1, kRadianDecimals, csv);
    }
    *csv += '\n';
    pieces->EndPart();
  }
}

}  // namespace

TextPieces FormatTrajectoryCsv(const PoseTrajectory& trajectory) {
  return [&trajectory](const TextSink& sink) {
    PieceWriter pieces(sink);
    *pieces.text() += CsvHeader(trajectory);
    AppendCsvRows(trajectory, &pieces);
    pieces.Flush();
  };
}

}  // namespace mmm_converter
