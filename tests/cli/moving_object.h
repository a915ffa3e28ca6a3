// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <string>

namespace mmm_converter::testing {

/// The places of a box's markers on it [m].
inline const Eigen::Matrix3Xd kBox = (Eigen::Matrix3Xd(3, 4) << 0.00, 0.16, 0.01, -0.05,  //
                                      0.02, -0.01, 0.09, 0.00,                            //
                                      0.00, 0.03, 0.05, 0.12)
                                         .finished();

/// Where an object is in a frame that turns and goes about. Those of another phase [rad, m] are
/// elsewhere.
Eigen::Isometry3d MovingPose(int frame, double phase = 0);

/// An MMM motion "box" of an object that slides 0.9 m high by 1 mm a frame, at 100 Hz.
std::string SlidingBox(const std::string& model_path, int frames);

}  // namespace mmm_converter::testing
