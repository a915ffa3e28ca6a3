// SPDX-License-Identifier: MIT
#include "common/io/tables/mot_writer.h"

#include <fmt/format.h>

#include <vector>

#include "common/io/tables/column_names.h"
#include "common/io/tables/table_rows.h"
#include "common/io/xml/xml_text.h"
#include "common/math/rotation.h"
#include "common/math/up_axis.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

// Nanoseconds, 0.1 micrometres, 0.0000001 degrees: not less than in the motion files.
constexpr int kMetreDecimals = 7;
constexpr int kDegreeDecimals = 7;

std::string MotHeader(const PoseTrajectory& trajectory, const std::string& root) {
  std::vector<std::string> columns = {"time"};
  for (const char* part : {"_tx", "_ty", "_tz", "_rx", "_ry", "_rz"})
    columns.push_back(root + part);
  columns.insert(columns.end(), trajectory.joint_names.begin(), trajectory.joint_names.end());
  columns = ColumnNames(columns);
  // OpenSim takes lines with "=" as keys, and ignores other lines before "endheader".
  return fmt::format(
      "Coordinates\nversion=1\nnRows={}\nnColumns={}\ninDegrees=yes\n\n"
      "Seconds, metres, degrees; y is up.\n"
      "The rotation of {} is Ry(ry) Rz(rz) Rx(rx), about axes that turn with it.\n"
      "endheader\n{}\n",
      trajectory.num_frames(), columns.size(), OneWord(root), fmt::join(columns, "\t"));
}

}  // namespace

TextPieces FormatMot(const PoseTrajectory& trajectory, const std::string& root) {
  const Eigen::Matrix3d to_y_up = RotationToZUp(UpAxis::kY).transpose();
  const auto row = [&trajectory, to_y_up, rpy = RpySeries()](int k, std::string* out) mutable {
    const Posture& q = trajectory.postures[k];
    AppendDecimal(trajectory.time(k), kSecondDecimals, out);
    AppendCells(Eigen::Vector3d(to_y_up * q.position), '\t', kMetreDecimals, "", out);
    // Turning the axes of both sides turns the three rotations' axes.
    const Eigen::Vector3d turns = kDegrees * (to_y_up * rpy.Next(q.orientation));
    AppendCells(turns, '\t', kDegreeDecimals, "", out);
    AppendCells(Eigen::VectorXd(kDegrees * q.joint_angles), '\t', kDegreeDecimals, "", out);
  };
  return TableText(MotHeader(trajectory, root), {0, trajectory.num_frames()}, row);
}

}  // namespace mmm_converter
