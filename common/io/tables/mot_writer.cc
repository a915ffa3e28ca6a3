// SPDX-License-Identifier: MIT
#include "common/io/tables/mot_writer.h"

#include <fmt/format.h>

#include <numbers>
#include <vector>

#include "common/io/tables/column_names.h"
#include "common/io/xml/xml_text.h"
#include "common/math/rotation.h"
#include "common/math/up_axis.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;
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

void AppendMotRows(const PoseTrajectory& trajectory, PieceWriter* pieces) {
  const Eigen::Matrix3d to_y_up = RotationToZUp(UpAxis::kY).transpose();
  std::string* const out = pieces->text();
  const auto append = [out](const auto& values, int decimals) {
    for (const double value : values) {
      *out += '\t';
      AppendDecimal(value, decimals, out);
    }
  };
  Eigen::Vector3d rpy = Eigen::Vector3d::Zero();
  for (int k = 0; k < trajectory.num_frames(); ++k) {
    const Posture& q = trajectory.postures[k];
    const Eigen::Vector3d principal = RpyFromRotation(q.orientation.toRotationMatrix());
    rpy = k == 0 ? principal : ContinuousRpy(principal, rpy);
    AppendDecimal(trajectory.time(k), kSecondDecimals, out);
    append(Eigen::Vector3d(to_y_up * q.position), kMetreDecimals);
    // Turning the axes of both sides turns the three rotations' axes.
    append(Eigen::Vector3d(kDegrees * (to_y_up * rpy)), kDegreeDecimals);
    append(Eigen::VectorXd(kDegrees * q.joint_angles), kDegreeDecimals);
    *out += '\n';
    pieces->EndPart();
  }
}

}  // namespace

TextPieces FormatMot(const PoseTrajectory& trajectory, const std::string& root) {
  return [&trajectory, root](const TextSink& sink) {
    PieceWriter pieces(sink);
    *pieces.text() += MotHeader(trajectory, root);
    AppendMotRows(trajectory, &pieces);
    pieces.Flush();
  };
}

}  // namespace mmm_converter
