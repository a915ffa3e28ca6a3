// SPDX-License-Identifier: MIT
#include "common/io/tables/osim_tables.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cassert>
#include <cmath>
#include <numbers>

#include "common/io/tables/column_names.h"
#include "common/io/tables/known_frames.h"
#include "common/io/xml/xml_text.h"
#include "common/math/up_axis.h"
#include "common/model/coordinate_map.h"
#include "common/model/forward_kinematics.h"
#include "common/motion/marker_synthesis.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

// As OpenSim has them: 10 nanometres, 1e-8 degrees.
constexpr int kOsimDecimals = 8;
constexpr double kDegreesOfTurn = 180 / std::numbers::pi;

std::string OsimHeader(const char* name, int rows, bool in_degrees,
                       const std::vector<std::string>& columns) {
  return fmt::format(
      "{}\nversion=1\nnRows={}\nnColumns={}\ninDegrees={}\n\n"
      "Units are S.I. units (second, meters, Newtons, ...)\n"
      "If the header above contains a line with 'inDegrees', this indicates whether rotational "
      "values are in degrees (yes) or radians (no).\n\nendheader\ntime\t{}\n",
      name, rows, columns.size() + 1, in_degrees ? "yes" : "no", fmt::join(columns, "\t"));
}

void AppendCell(double value, std::string* out) {
  *out += '\t';
  if (std::isfinite(value)) {
    AppendDecimal(value, kOsimDecimals, out);
  } else {
    *out += "nan";
  }
}

/// A table of a row for each of these frames: row(k, out) appends its cells.
template <typename Row>
void AppendRows(const PoseTrajectory& trajectory, KnownFrames frames, const std::string& header,
                const Row& row, const TextSink& sink) {
  PieceWriter pieces(sink);
  *pieces.text() += header;
  for (int k = frames.begin; k < frames.end; ++k) {
    AppendDecimal(trajectory.time(k), kOsimDecimals, pieces.text());
    row(k, pieces.text());
    *pieces.text() += '\n';
    pieces.EndPart();
  }
  pieces.Flush();
}

template <typename Row>
void AppendTable(const PoseTrajectory& trajectory, const std::string& header, const Row& row,
                 const TextSink& sink) {
  AppendRows(trajectory, {0, trajectory.num_frames()}, header, row, sink);
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
    units[static_cast<Eigen::Index>(i)] = is_turn ? kDegreesOfTurn : 1;
  }
  return units;
}

}  // namespace

TextPieces FormatOsimMotion(const KinematicModel& model, const PoseTrajectory& trajectory) {
  assert(model.coordinates() != nullptr);
  return [&model, &trajectory](const TextSink& sink) {
    const Eigen::VectorXd units = UnitsOf(*model.coordinates());
    CoordinateSeries series(model);
    const auto row = [&](int k, std::string* out) {
      const Eigen::VectorXd& values = series.Next(ModelPosture(model, trajectory, k));
      for (Eigen::Index i = 0; i < values.size(); ++i) AppendCell(units[i] * values[i], out);
    };
    AppendTable(trajectory,
                OsimHeader("Coordinates", trajectory.num_frames(), true, CoordinateNames(model)),
                row, sink);
  };
}

TextPieces FormatOsimDeviations(const KinematicModel& model, const PoseTrajectory& trajectory) {
  assert(model.coordinates() != nullptr);
  return [&model, &trajectory](const TextSink& sink) {
    const Eigen::VectorXd units = UnitsOf(*model.coordinates());
    std::vector<int> joints;
    for (const std::string& name : trajectory.joint_names) joints.push_back(model.FindJoint(name));
    Eigen::VectorXd all = Eigen::VectorXd::Zero(6 + model.num_joints());
    CoordinateSeries series(model);
    const auto row = [&](int k, std::string* out) {
      const Posture posture = ModelPosture(model, trajectory, k);
      series.Next(posture);
      const auto tracked = trajectory.standard_deviations.col(k);
      all.head<6>() = tracked.head<6>();
      for (std::size_t j = 0; j < joints.size(); ++j) {
        all[6 + joints[j]] = tracked[6 + static_cast<Eigen::Index>(j)];
      }
      const Eigen::VectorXd deviations = series.Deviations(posture, all);
      for (Eigen::Index i = 0; i < deviations.size(); ++i) {
        AppendCell(units[i] * deviations[i], out);
      }
    };
    AppendTable(trajectory,
                OsimHeader(kOsimDeviations, trajectory.num_frames(), true, CoordinateNames(model)),
                row, sink);
  };
}

TextPieces FormatOsimMarkers(const KinematicModel& model, const PoseTrajectory& trajectory,
                             const std::vector<MarkerIx>& markers) {
  return [&model, &trajectory, markers](const TextSink& sink) {
    std::vector<std::string> columns;
    for (const MarkerIx marker : markers) {
      const std::string name = OneWord(model.markers()[marker].name);
      for (const char* part : {"_tx", "_ty", "_tz"}) columns.push_back(name + part);
    }
    const Eigen::Matrix3d R_WG =
        model.coordinates() ? model.coordinates()->R_WG() : RotationToZUp(UpAxis::kY);
    const Eigen::Matrix3d R_GW = R_WG.transpose();
    const auto row = [&](int k, std::string* out) {
      const Eigen::Matrix3Xd p_WM = MarkerPositions(model, ModelPosture(model, trajectory, k));
      for (const MarkerIx marker : markers) {
        const Eigen::Vector3d p_GM = R_GW * p_WM.col(marker);
        for (int i = 0; i < 3; ++i) AppendCell(p_GM[i], out);
      }
    };
    AppendTable(trajectory,
                OsimHeader("Model Marker Locations from IK", trajectory.num_frames(), false,
                           ColumnNames(columns)),
                row, sink);
  };
}

TextPieces FormatOsimMarkerErrors(const std::vector<std::string>& names,
                                  const Eigen::MatrixXd& errors, const PoseTrajectory& trajectory) {
  return [names, &errors, &trajectory](const TextSink& sink) {
    std::vector<std::string> columns = {"total_squared_error", "marker_error_RMS",
                                        "marker_error_max"};
    columns.insert(columns.end(), names.begin(), names.end());
    const auto row = [&](int k, std::string* out) {
      double squares = 0;
      double most = 0;
      int seen = 0;
      for (const double error : errors.col(k)) {
        if (!std::isfinite(error)) continue;
        squares += error * error;
        most = std::max(most, error);
        ++seen;
      }
      AppendCell(squares, out);
      AppendCell(std::sqrt(squares / std::max(seen, 1)), out);
      AppendCell(most, out);
      for (const double error : errors.col(k)) AppendCell(error, out);
    };
    const KnownFrames frames = FramesWithValues(errors);
    AppendRows(
        trajectory, frames,
        OsimHeader("Model Marker Errors from IK", frames.count(), false, ColumnNames(columns)), row,
        sink);
  };
}

}  // namespace mmm_converter
