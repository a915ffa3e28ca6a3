// SPDX-License-Identifier: MIT
#include "common/convert/tracked_joints.h"

namespace mmm_converter {

std::vector<std::string> TrackedJoints(const TrackingSetup& setup) {
  std::vector<std::string> names;
  names.reserve(setup.joints.size());
  for (const int joint : setup.joints) names.push_back(setup.model->joint(joint).name);
  return names;
}

std::vector<std::string> UsedLabels(const TrackingSetup& setup,
                                    const std::vector<std::string>& labels) {
  std::vector<std::string> used;
  used.reserve(setup.assignments().size());
  for (const MarkerAssignment& one : setup.assignments()) {
    used.push_back(labels[static_cast<std::size_t>(one.label)]);
  }
  return used;
}

void TakeTracked(const TrackingSetup& setup, const FrameEstimate& estimate, Posture* posture,
                 Eigen::Ref<Eigen::VectorXd> deviations) {
  const auto count = static_cast<Eigen::Index>(setup.joints.size());
  const bool has_deviations = estimate.standard_deviations.size() > 0;
  posture->position = estimate.posture.position;
  posture->orientation = estimate.posture.orientation;
  posture->joint_angles.resize(count);
  if (has_deviations) deviations.head<6>() = estimate.standard_deviations.head<6>();
  for (Eigen::Index i = 0; i < count; ++i) {
    const int joint = setup.joints[static_cast<std::size_t>(i)];
    posture->joint_angles[i] = estimate.posture.joint_angles[joint];
    if (has_deviations) deviations[6 + i] = estimate.standard_deviations[6 + joint];
  }
}

}  // namespace mmm_converter
