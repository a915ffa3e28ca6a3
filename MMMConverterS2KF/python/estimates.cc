// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/python/estimates.h"

#include "MMMConverterS2KF/python/arrays.h"

namespace mmm_converter::python {

namespace py = pybind11;

py::dict EstimateDict(const TrackingSetup& setup, const FrameEstimate& estimate) {
  const std::vector<int>& joints = setup.joints;
  const auto count = static_cast<Eigen::Index>(joints.size());
  Posture posture = estimate.posture;
  posture.joint_angles.resize(count);
  Eigen::VectorXd deviations;
  if (estimate.standard_deviations.size() > 0) {
    deviations.resize(6 + count);
    deviations.head<6>() = estimate.standard_deviations.head<6>();
  }
  for (Eigen::Index i = 0; i < count; ++i) {
    posture.joint_angles[i] = estimate.posture.joint_angles[joints[i]];
    if (deviations.size() > 0) deviations[6 + i] = estimate.standard_deviations[6 + joints[i]];
  }
  const py::tuple arrays = PostureArrays(posture);
  py::dict result;
  result["root_position"] = arrays[0];
  result["root_quaternion"] = arrays[1];
  result["joints"] = arrays[2];
  result["sd"] = deviations.size() == 0 ? py::object(py::none())
                                        : py::array_t<double>(deviations.size(), deviations.data());
  result["residuals"] = py::array_t<double>(estimate.residuals.size(), estimate.residuals.data());
  result["markers_seen"] = estimate.markers_seen;
  result["markers_wrong"] = estimate.markers_wrong;
  result["nis"] = estimate.nis;
  result["reassembled"] = estimate.reassembled;
  result["converged"] = estimate.converged;
  return result;
}

std::vector<std::string> TrackedJoints(const TrackingSetup& setup) {
  std::vector<std::string> names;
  names.reserve(setup.joints.size());
  for (const int joint : setup.joints) names.push_back(setup.model->joint(joint).name);
  return names;
}

std::vector<std::string> UsedLabels(const TrackingSetup& setup,
                                    const std::vector<std::string>& labels) {
  std::vector<std::string> used;
  for (const MarkerAssignment& one : setup.assignments()) {
    used.push_back(labels[static_cast<std::size_t>(one.label)]);
  }
  return used;
}

}  // namespace mmm_converter::python
