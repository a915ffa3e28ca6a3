// SPDX-License-Identifier: MIT
#include "common/io/tables/trajectory_csv.h"

#include <string>
#include <vector>

#include "common/io/tables/column_names.h"
#include "common/io/tables/table_rows.h"
#include "common/io/xml/xml_text.h"
#include "common/math/rotation.h"
#include "common/support/units.h"

namespace mmm_converter {

namespace {

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

}  // namespace

TextPieces FormatTrajectoryCsv(const PoseTrajectory& trajectory) {
  const auto row = [&trajectory, rpy = RpySeries()](int k, std::string* csv) mutable {
    const Posture& q = trajectory.postures[k];
    AppendDecimal(trajectory.time(k), kSecondDecimals, csv);
    AppendCsvCells(kMillimetres * q.position, kMillimetreDecimals, csv);
    AppendCsvCells(rpy.Next(q.orientation), kRadianDecimals, csv);
    AppendCsvCells(q.joint_angles, kRadianDecimals, csv);
    for (const Eigen::MatrixXd* values :
         {&trajectory.standard_deviations, &trajectory.velocities, &trajectory.accelerations}) {
      if (values->size() == 0) continue;
      AppendCsvCells(kMillimetres * values->col(k).head<3>(), kMillimetreDecimals, csv);
      AppendCsvCells(values->col(k).tail(values->rows() - 3), kRadianDecimals, csv);
    }
  };
  return TableText(CsvHeader(trajectory), {0, trajectory.num_frames()}, row);
}

}  // namespace mmm_converter
