// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "common/retarget/human_body.h"

namespace mmm_converter {

/// SMPL-X's body joints: Pelvis, L_Hip, R_Hip, Spine1, L_Knee, R_Knee, Spine2, L_Ankle, R_Ankle,
/// Spine3, L_Foot, R_Foot, Neck, L_Collar, R_Collar, Head, L_Shoulder, R_Shoulder, L_Elbow,
/// R_Elbow, L_Wrist, R_Wrist.
const std::vector<std::string>& KeypointNames();

/// Their places in a person's motion at that rate [Hz]: x, y, z of each [m], W; a column a frame,
/// from the first frame on, linear between two of the motion's. Limbs are at the model's joint
/// centres, L_Foot and R_Foot at the toes (HumanMotion::toes). Those between are not the model's:
/// spine and neck divide the way from mid-hip to between the shoulders, collars that from the neck
/// to a shoulder; the head is a tenth of the height [m] above the neck.
Eigen::MatrixXd Keypoints(const HumanMotion& motion, double height, double rate);

}  // namespace mmm_converter
