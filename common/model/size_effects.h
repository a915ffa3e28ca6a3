// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "common/math/padded_matrix.h"
#include "common/model/kinematic_model.h"
#include "common/model/marker_kinematics.h"

namespace mmm_converter {

/// How far a person may be from a model whose sizes are not theirs, of each part on its own.
struct SizeDeviations {
  double whole = 0.05;  ///< in all directions alike, as a share of the size
  double along = 0.03;  ///< along each axis besides
};

/// How markers move by the sizes of a model's parts, of which those of left and right, by their
/// names, are as large. A part is a rigid link of MarkerKinematics with the markers that it carries
/// and the joints to which it leads. Immutable.
class SizeEffects {
 public:
  SizeEffects() = default;
  SizeEffects(const KinematicModel& model, const MarkerKinematics& kinematics,
              const SizeDeviations& deviations);

  /// Columns of Compute.
  int num_effects() const { return kEffects * num_parts_; }

  /// effects: 3 markers x num_effects [m], what each moves every marker by, in W, if it is off by
  /// its deviation. at: markers and links of a posture.
  void Compute(const MarkerJacobian& at, PaddedMatrix* effects) const;

 private:
  static constexpr int kEffects = 4;  // of a part: as a whole, and along its link's axes

  SizeDeviations deviations_;
  int num_parts_ = 0;
  std::vector<int> part_;    // by link; -1: has no size
  std::vector<int> parent_;  // by link
  std::vector<int> link_;    // by marker
};

}  // namespace mmm_converter
