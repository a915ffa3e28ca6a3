// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <Eigen/Core>
#include <string>
#include <vector>

#include "MMMConverterS2KF/report/json.h"
#include "common/model/kinematic_model.h"
#include "common/motion/pose_trajectory.h"

namespace mmm_converter::python {

/// Numbers as Python gives them: converted to float64 in C order where they are something else.
using Numbers = pybind11::array_t<double, pybind11::array::c_style | pybind11::array::forcecast>;

/// A copy of a matrix with a column for each frame as an array (frames, rows). Empty: None.
pybind11::object RowsOfColumns(const Eigen::MatrixXd& columns);

/// Root positions (frames, 3) [m], quaternions w, x, y, z (frames, 4), joint angles (frames, n).
pybind11::tuple PostureArrays(const std::vector<Posture>& postures, int num_joints);

/// What PostureArrays makes of one posture.
pybind11::tuple PostureArrays(const Posture& posture);

/// The other way: names of the joints are the columns'. @throws Error where a shape is wrong.
PoseTrajectory TrajectoryOf(const Numbers& positions, const Numbers& quaternions,
                            const Numbers& angles, const std::vector<std::string>& names);

/// (joint, side, motion) of each anatomical angle, angles and standard deviations, (frames, angles)
/// [rad]; None where the motion has no deviations. @throws Error where the model has no legs.
pybind11::tuple AnglesOf(const KinematicModel& model, const PoseTrajectory& motion);

/// The dictionary or list that JSON says.
pybind11::object PythonOf(const Json& json);

/// @throws Error naming `what` where the array has another shape; -1: any size.
void CheckShape(const Numbers& numbers, const std::vector<pybind11::ssize_t>& shape,
                const std::string& what);

}  // namespace mmm_converter::python
