// SPDX-License-Identifier: MIT
#include "common/io/tables/osim_tables.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cassert>
#include <cmath>
#include <vector>

#include "common/io/tables/column_names.h"
#include "common/io/tables/table_rows.h"
#include "common/io/xml/xml_text.h"
#include "common/math/rotation.h"
#include "common/math/up_axis.h"
#include "common/model/coordinate_map.h"
#include "common/model/forward_kinematics.h"
#include "common/motion/marker_synthesis.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

// As OpenSim has them: 10 nanometres, 1e-8 degrees.
constexpr int kOsimDecimals = 8;

std::string OsimHeader(const char* name, int rows, bool in_degrees,
                       const std::vector<std::string>& columns) {
  return fmt::format(
      "{}\nversion=1\nnRows={}\nnColumns={}\ninDegrees={}\n\n"
      "Units are S.I. units (second, meters, Newtons, ...)\n"
      "If the header above contains a line with 'inDegrees', this indicates whether rotational "
      "values are in degrees (yes) or radians (no).\n\nendheader\ntime\t{}\n",
      name, rows, columns.size() + 1, in_degrees ? "yes" : "no", fmt::join(columns, "\t"));
}

template <typename Values>
void AppendOsimCells(const Values& values, std::string* out) {
  AppendCells(values, '\t', kOsimDecimals, "nan", out);
}

std::vector<std::string> CoordinateNames(const KinematicModel& model) {
  std::vector<std::string> names;
  for (const ModelCoordinate& one : model.coordinates()->coordinates()) names.push_back(one.name);
  return names;
}

/// By coordinate: degrees for a radian of a turn, 1 for all else.
Eigen::VectorXd UnitsOf(const CoordinateMap& map) {
  Eigen::VectorXd units(map.coordinates().size());
  for (std::size_t i = 0; i < map.coordinates().size(); ++i) {
    const bool is_turn = map.coordinates()[i].kind == ModelCoordinate::Kind::kTurn;
    units[static_cast<Eigen::Index>(i)] = is_turn ? kDegrees : 1;
  }
  return units;
}

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

TextPieces FormatOsimMotion(const KinematicModel& model, const PoseTrajectory& trajectory) {
  assert(model.coordinates() != nullptr);
  const auto row = [&model, &trajectory, units = UnitsOf(*model.coordinates()),
                    series = CoordinateSeries(model)](int k, std::string* out) mutable {
    AppendDecimal(trajectory.time(k), kOsimDecimals, out);
    AppendOsimCells(units.cwiseProduct(series.Next(ModelPosture(model, trajectory, k))), out);
  };
  return TableText(OsimHeader("Coordinates", trajectory.num_frames(), true, CoordinateNames(model)),
                   {0, trajectory.num_frames()}, row);
}

TextPieces FormatOsimDeviations(const KinematicModel& model, const PoseTrajectory& trajectory) {
  assert(model.coordinates() != nullptr);
  std::vector<int> joints;
  for (const std::string& name : trajectory.joint_names) joints.push_back(model.FindJoint(name));
  const auto row = [&model, &trajectory, joints, units = UnitsOf(*model.coordinates()),
                    series = CoordinateSeries(model)](int k, std::string* out) mutable {
    const Posture posture = ModelPosture(model, trajectory, k);
    series.Next(posture);
    const auto tracked = trajectory.standard_deviations.col(k);
    Eigen::VectorXd all = Eigen::VectorXd::Zero(6 + model.num_joints());
    all.head<6>() = tracked.head<6>();
    for (std::size_t j = 0; j < joints.size(); ++j) {
      all[6 + joints[j]] = tracked[6 + static_cast<Eigen::Index>(j)];
    }
    AppendDecimal(trajectory.time(k), kOsimDecimals, out);
    AppendOsimCells(units.cwiseProduct(series.Deviations(posture, all)), out);
  };
  return TableText(
      OsimHeader(kOsimDeviations, trajectory.num_frames(), true, CoordinateNames(model)),
      {0, trajectory.num_frames()}, row);
}

TextPieces FormatOsimMarkers(const KinematicModel& model, const PoseTrajectory& trajectory,
                             const std::vector<MarkerIx>& markers) {
  std::vector<std::string> columns;
  for (const MarkerIx marker : markers) {
    const std::string name = OneWord(model.markers()[marker].name);
    for (const char* part : {"_tx", "_ty", "_tz"}) columns.push_back(name + part);
  }
  const Eigen::Matrix3d R_WG =
      model.coordinates() ? model.coordinates()->R_WG() : RotationToZUp(UpAxis::kY);
  const Eigen::Matrix3d R_GW = R_WG.transpose();
  const auto row = [&model, &trajectory, markers, R_GW](int k, std::string* out) {
    AppendDecimal(trajectory.time(k), kOsimDecimals, out);
    const Eigen::Matrix3Xd p_WM = MarkerPositions(model, ModelPosture(model, trajectory, k));
    for (const MarkerIx marker : markers) {
      AppendOsimCells(Eigen::Vector3d(R_GW * p_WM.col(marker)), out);
    }
  };
  return TableText(OsimHeader("Model Marker Locations from IK", trajectory.num_frames(), false,
                              ColumnNames(columns)),
                   {0, trajectory.num_frames()}, row);
}

TextPieces FormatOsimMarkerErrors(const std::vector<std::string>& names,
                                  const Eigen::MatrixXd& errors, const PoseTrajectory& trajectory) {
  std::vector<std::string> columns = {"total_squared_error", "marker_error_RMS",
                                      "marker_error_max"};
  columns.insert(columns.end(), names.begin(), names.end());
  const auto row = [&errors, &trajectory](int k, std::string* out) {
    double squares = 0;
    double most = 0;
    int seen = 0;
    for (const double error : errors.col(k)) {
      if (!std::isfinite(error)) continue;
      squares += error * error;
      most = std::max(most, error);
      ++seen;
    }
    AppendDecimal(trajectory.time(k), kOsimDecimals, out);
    AppendOsimCells(Eigen::Vector3d(squares, std::sqrt(squares / std::max(seen, 1)), most), out);
    AppendOsimCells(errors.col(k), out);
  };
  const TableRows rows = RowsWithValues(errors);
  return TableText(
      OsimHeader("Model Marker Errors from IK", rows.count(), false, ColumnNames(columns)), rows,
      row);
}

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
