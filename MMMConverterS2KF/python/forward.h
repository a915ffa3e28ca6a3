// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "common/model/kinematic_model.h"

namespace mmm_converter::python {

/// Postures and what is computed of them, arrays in C order with frames first.
struct ForwardArrays {
  const double* positions;    ///< frames x 3, of the root [m]
  const double* quaternions;  ///< frames x 4, w, x, y, z
  const double* angles;       ///< frames x joints [rad]
  double* p_WS;               ///< frames x segments x 3 [m]
  double* R_WS;               ///< frames x segments x 3 x 3
  double* p_WM;               ///< frames x markers x 3 [m]
};

/// Poses of all segments and places of all markers, to the bit those of SegmentPoses. joints: the
/// model's, of the columns of angles; others are as in ZeroPosture.
void ComputeForward(const KinematicModel& model, const std::vector<int>& joints,
                    std::ptrdiff_t frames, const ForwardArrays& arrays);

/// Places of all markers alone; p_WS and R_WS are not used.
void ComputeMarkerPlaces(const KinematicModel& model, const std::vector<int>& joints,
                         std::ptrdiff_t frames, const ForwardArrays& arrays);

}  // namespace mmm_converter::python
