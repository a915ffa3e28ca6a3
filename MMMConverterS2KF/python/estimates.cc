// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/python/estimates.h"

#include "MMMConverterS2KF/python/arrays.h"
#include "common/convert/tracked_joints.h"

namespace mmm_converter::python {

namespace py = pybind11;

py::dict EstimateDict(const TrackingSetup& setup, const FrameEstimate& estimate) {
  Posture posture;
  Eigen::VectorXd deviations;
  if (estimate.standard_deviations.size() > 0) {
    deviations.resize(6 + static_cast<Eigen::Index>(setup.joints.size()));
  }
  TakeTracked(setup, estimate, &posture, deviations);
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

}  // namespace mmm_converter::python
