// SPDX-License-Identifier: MIT
#include "common/io/tables/pose_table.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

#include "common/io/tables/column_names.h"
#include "common/io/tables/npz_writer.h"
#include "common/io/tables/table_rows.h"
#include "common/io/xml/xml_text.h"
#include "common/math/rotation.h"
#include "common/support/error.h"
#include "common/support/text.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

// 0.1 micrometres; of rotations as many as of radians.
constexpr int kPoseMetreDecimals = 7;

const std::vector<std::string> kXyz = {"x", "y", "z"};

std::vector<std::string> RotationColumns(RotationForm form) {
  if (form == RotationForm::kQuaternion) return {"qw", "qx", "qy", "qz"};
  if (form == RotationForm::kRotationVector) return {"rx_rad", "ry_rad", "rz_rad"};
  return {"r11", "r12", "r13", "r21", "r22", "r23", "r31", "r32", "r33"};
}

void AppendRotation(const Eigen::Ref<const Eigen::Vector4d>& wxyz, RotationForm form,
                    std::vector<double>* out) {
  const Eigen::Quaterniond q(wxyz[0], wxyz[1], wxyz[2], wxyz[3]);
  if (form == RotationForm::kQuaternion) {
    out->insert(out->end(), {q.w(), q.x(), q.y(), q.z()});
  } else if (form == RotationForm::kRotationVector) {
    const Eigen::Vector3d w = wxyz.allFinite() ? Log(q) : Eigen::Vector3d::Constant(kNaN);
    out->insert(out->end(), {w[0], w[1], w[2]});
  } else {
    const Eigen::Matrix3d R = q.toRotationMatrix();
    for (int i = 0; i < 3; ++i) out->insert(out->end(), {R(i, 0), R(i, 1), R(i, 2)});
  }
}

// Names of bodies and points as parts of columns, each once.
struct PoseColumns {
  std::vector<std::string> bodies, points;
  std::size_t segments = 0;
};

PoseColumns ColumnNamesOf(const BodyPoses& poses) {
  std::vector<std::string> names = poses.segments;
  names.insert(names.end(), poses.objects.begin(), poses.objects.end());
  for (const std::string& point : poses.points) names.push_back("point_" + point);
  names = CsvColumnNames(std::move(names));
  const auto points = names.end() - static_cast<std::ptrdiff_t>(poses.points.size());
  return {{names.begin(), points}, {points, names.end()}, poses.segments.size()};
}

std::string PoseHeader(const BodyPoses& poses, RotationForm form) {
  const PoseColumns names = ColumnNamesOf(poses);
  std::string header = "time_s";
  const auto append = [&](const std::string& name, const std::vector<std::string>& parts,
                          const std::string& unit) {
    for (const std::string& part : parts) {
      header.append(",").append(name).append("_").append(part).append(unit);
    }
  };
  for (const std::string& name : names.bodies) {
    append(name, kXyz, "_m");
    append(name, RotationColumns(form), "");
  }
  for (const std::string& name : names.points) append(name, kXyz, "_m");
  if (poses.center_of_mass.size() > 0) append("com", kXyz, "_m");
  if (poses.point_velocities.size() + poses.velocities.size() > 0) {
    for (std::size_t i = 0; i < names.segments; ++i) {
      append("d_" + names.bodies[i], kXyz, "_m_per_s");
      append("d_" + names.bodies[i], {"about_x", "about_y", "about_z"}, "_rad_per_s");
    }
    for (const std::string& name : names.points) append("d_" + name, kXyz, "_m_per_s");
  }
  if (poses.center_of_mass_velocity.size() > 0) append("d_com", kXyz, "_m_per_s");
  return header + "\n";
}

void AppendPoseRow(const BodyPoses& poses, RotationForm form, int k, std::string* out) {
  AppendDecimal(poses.time(k), kSecondDecimals, out);
  std::vector<double> rotation;
  for (int b = 0; b < poses.num_bodies(); ++b) {
    AppendCsvCells(poses.positions.col(k).segment<3>(3 * b), kPoseMetreDecimals, out);
    rotation.clear();
    AppendRotation(poses.quaternions.col(k).segment<4>(4 * b), form, &rotation);
    AppendCsvCells(rotation, kRadianDecimals, out);
  }
  AppendCsvCells(poses.point_positions.col(k), kPoseMetreDecimals, out);
  if (poses.center_of_mass.size() > 0) {
    AppendCsvCells(poses.center_of_mass.col(k), kPoseMetreDecimals, out);
  }
  for (Eigen::Index row = 0; row < poses.velocities.rows(); row += 3) {
    AppendCsvCells(poses.velocities.col(k).segment<3>(row), kPoseMetreDecimals, out);
    AppendCsvCells(poses.angular_velocities.col(k).segment<3>(row), kRadianDecimals, out);
  }
  if (poses.point_velocities.size() > 0) {
    AppendCsvCells(poses.point_velocities.col(k), kPoseMetreDecimals, out);
  }
  if (poses.center_of_mass_velocity.size() > 0) {
    AppendCsvCells(poses.center_of_mass_velocity.col(k), kPoseMetreDecimals, out);
  }
}

// Makes the arrays of a file.
class PoseArrays {
 public:
  explicit PoseArrays(const BodyPoses& poses) : poses_(poses), frames_(poses.num_frames()) {}

  void AddText(const std::string& name, const std::string& text) {
    arrays_.push_back({name, {}, {}, {text}});
  }

  void AddNames(const std::string& name, const std::vector<std::string>& names) {
    arrays_.push_back({name, {static_cast<std::int64_t>(names.size())}, {}, names});
  }

  void AddTimes() {
    NpyArray times = {"time", {frames_}, {}, {}};
    for (int k = 0; k < poses_.num_frames(); ++k) times.numbers.push_back(poses_.time(k));
    arrays_.push_back(std::move(times));
    arrays_.push_back({"rate", {}, {poses_.rate}, {}});
  }

  // Vectors of three in rows [begin, begin + 3 n).
  void AddVectors(const std::string& name, const Eigen::MatrixXd& values, int begin, int n) {
    NpyArray array = {name, {frames_, n, 3}, {}, {}};
    const Eigen::MatrixXd part = values.middleRows(begin, 3 * n);
    array.numbers.assign(part.data(), part.data() + part.size());
    arrays_.push_back(std::move(array));
  }

  void AddVector(const std::string& name, const Eigen::MatrixXd& values) {
    AddVectors(name, values, 0, 1);
    arrays_.back().shape = {frames_, 3};
  }

  void AddRotations(const std::string& name, RotationForm form, int begin, int n) {
    NpyArray array = {name, {frames_, n}, {}, {}};
    if (form == RotationForm::kMatrix) {
      array.shape.insert(array.shape.end(), {3, 3});
    } else {
      array.shape.push_back(form == RotationForm::kQuaternion ? 4 : 3);
    }
    for (Eigen::Index k = 0; k < frames_; ++k) {
      for (int b = begin; b < begin + n; ++b) {
        AppendRotation(poses_.quaternions.col(k).segment<4>(4 * b), form, &array.numbers);
      }
    }
    arrays_.push_back(std::move(array));
  }

  std::vector<NpyArray> Take() { return std::move(arrays_); }

 private:
  const BodyPoses& poses_;
  std::int64_t frames_;
  std::vector<NpyArray> arrays_;
};

const char* NameOfForm(RotationForm form) {
  if (form == RotationForm::kQuaternion) return "quaternion wxyz";
  return form == RotationForm::kRotationVector ? "rotation vector" : "matrix";
}

std::vector<NpyArray> PoseArraysOf(const BodyPoses& poses, RotationForm form) {
  const int segments = static_cast<int>(poses.segments.size());
  const int objects = static_cast<int>(poses.objects.size());
  const int points = static_cast<int>(poses.points.size());
  PoseArrays arrays(poses);
  arrays.AddTimes();
  arrays.AddText("frame", poses.relative_to_root ? "root" : "world");
  arrays.AddText("rotation", NameOfForm(form));
  if (segments > 0) {
    arrays.AddNames("segments", poses.segments);
    arrays.AddVectors("segment_positions", poses.positions, 0, segments);
    arrays.AddRotations("segment_rotations", form, 0, segments);
  }
  if (objects > 0) {
    arrays.AddNames("objects", poses.objects);
    arrays.AddVectors("object_positions", poses.positions, 3 * segments, objects);
    arrays.AddRotations("object_rotations", form, segments, objects);
  }
  if (points > 0) {
    arrays.AddNames("points", poses.points);
    arrays.AddVectors("point_positions", poses.point_positions, 0, points);
  }
  if (poses.center_of_mass.size() > 0) arrays.AddVector("center_of_mass", poses.center_of_mass);
  if (poses.velocities.size() > 0) {
    arrays.AddVectors("segment_velocities", poses.velocities, 0, segments);
    arrays.AddVectors("segment_angular_velocities", poses.angular_velocities, 0, segments);
  }
  if (poses.point_velocities.size() > 0) {
    arrays.AddVectors("point_velocities", poses.point_velocities, 0, points);
  }
  if (poses.center_of_mass_velocity.size() > 0) {
    arrays.AddVector("center_of_mass_velocity", poses.center_of_mass_velocity);
  }
  return arrays.Take();
}

}  // namespace

RotationForm ParseRotationForm(const std::string& text) {
  if (text == "quaternion") return RotationForm::kQuaternion;
  if (text == "vector") return RotationForm::kRotationVector;
  if (text == "matrix") return RotationForm::kMatrix;
  throw Error("\"" + text + "\" is no form of a rotation; use quaternion, vector or matrix");
}

TextPieces FormatPoseCsv(const BodyPoses& poses, RotationForm rotation) {
  return TableText(
      PoseHeader(poses, rotation), {0, poses.num_frames()},
      [&poses, rotation](int k, std::string* out) { AppendPoseRow(poses, rotation, k, out); });
}

TextPieces FormatPoseNpz(const BodyPoses& poses, RotationForm rotation) {
  const auto arrays = std::make_shared<const std::vector<NpyArray>>(PoseArraysOf(poses, rotation));
  const TextPieces file = FormatNpz(*arrays);
  return [arrays, file](const TextSink& sink) { file(sink); };
}

TextPieces FormatPoseFile(const std::string& file, const BodyPoses& poses, RotationForm rotation) {
  const std::string ending = ToLower(std::filesystem::path(file).extension().string());
  return ending == ".npz" ? FormatPoseNpz(poses, rotation) : FormatPoseCsv(poses, rotation);
}

}  // namespace mmm_converter
