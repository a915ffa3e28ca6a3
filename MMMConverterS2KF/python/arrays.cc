// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/python/arrays.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "common/motion/anatomical_angles.h"
#include "common/support/error.h"

namespace mmm_converter::python {

namespace py = pybind11;

namespace {

std::string ShapeText(const py::ssize_t* sizes, std::size_t count) {
  std::string text = "(";
  for (std::size_t i = 0; i < count; ++i) {
    text += (i == 0 ? "" : ", ") + (sizes[i] < 0 ? "n" : std::to_string(sizes[i]));
  }
  return text + (count == 1 ? ",)" : ")");
}

}  // namespace

py::object RowsOfColumns(const Eigen::MatrixXd& columns) {
  if (columns.size() == 0) return py::none();
  py::array_t<double> rows({columns.cols(), columns.rows()});
  std::copy(columns.data(), columns.data() + columns.size(), rows.mutable_data());
  return rows;
}

py::tuple PostureArrays(const std::vector<Posture>& postures, int num_joints) {
  const auto frames = static_cast<py::ssize_t>(postures.size());
  py::array_t<double> positions({frames, py::ssize_t{3}});
  py::array_t<double> quaternions({frames, py::ssize_t{4}});
  py::array_t<double> joints({frames, static_cast<py::ssize_t>(num_joints)});
  double* p = positions.mutable_data();
  double* q = quaternions.mutable_data();
  double* angles = joints.mutable_data();
  for (const Posture& posture : postures) {
    p = std::copy(posture.position.data(), posture.position.data() + 3, p);
    *q++ = posture.orientation.w();
    q = std::copy(posture.orientation.vec().data(), posture.orientation.vec().data() + 3, q);
    angles =
        std::copy(posture.joint_angles.data(), posture.joint_angles.data() + num_joints, angles);
  }
  return py::make_tuple(positions, quaternions, joints);
}

py::tuple PostureArrays(const Posture& posture) {
  const Eigen::Quaterniond& q = posture.orientation;
  const std::vector<double> wxyz = {q.w(), q.x(), q.y(), q.z()};
  return py::make_tuple(
      py::array_t<double>(3, posture.position.data()), py::array_t<double>(4, wxyz.data()),
      py::array_t<double>(posture.joint_angles.size(), posture.joint_angles.data()));
}

PoseTrajectory TrajectoryOf(const Numbers& positions, const Numbers& quaternions,
                            const Numbers& angles, const std::vector<std::string>& names) {
  CheckShape(positions, {-1, 3}, "root_positions");
  const py::ssize_t frames = positions.shape(0);
  CheckShape(quaternions, {frames, 4}, "root_quaternions");
  const auto count = static_cast<py::ssize_t>(names.size());
  CheckShape(angles, {frames, count}, "joints");
  PoseTrajectory trajectory;
  trajectory.rate = 1;
  trajectory.joint_names = names;
  for (py::ssize_t k = 0; k < frames; ++k) {
    const double* q = quaternions.data(k, 0);
    const double* joints = angles.data() + k * count;
    trajectory.postures.push_back({Eigen::Map<const Eigen::Vector3d>(positions.data(k, 0)),
                                   Eigen::Quaterniond(q[0], q[1], q[2], q[3]),
                                   Eigen::Map<const Eigen::VectorXd>(joints, count)});
  }
  return trajectory;
}

py::tuple AnglesOf(const KinematicModel& model, const PoseTrajectory& motion) {
  AnatomicalAngles angles;
  {
    const py::gil_scoped_release release;
    angles = ComputeAnatomicalAngles(model, motion);
  }
  py::list names;
  for (const AnatomicalAngle& one : angles.angles) {
    names.append(py::make_tuple(one.joint, one.side, one.motion));
  }
  return py::make_tuple(names, RowsOfColumns(angles.values), RowsOfColumns(angles.deviations));
}

py::object PythonOf(const Json& json) {
  return py::module_::import("json").attr("loads")(FormatJsonLine(json));
}

void CheckShape(const Numbers& numbers, const std::vector<py::ssize_t>& shape,
                const std::string& what) {
  bool fits = numbers.ndim() == static_cast<py::ssize_t>(shape.size());
  for (std::size_t i = 0; fits && i < shape.size(); ++i) {
    fits = shape[i] < 0 || numbers.shape(static_cast<py::ssize_t>(i)) == shape[i];
  }
  if (fits) return;
  throw Error(fmt::format("{}: has the shape {}; {} is expected", what,
                          ShapeText(numbers.shape(), static_cast<std::size_t>(numbers.ndim())),
                          ShapeText(shape.data(), shape.size())));
}

}  // namespace mmm_converter::python
