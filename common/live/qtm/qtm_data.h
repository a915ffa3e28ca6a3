// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace mmm_converter {

/// Parts of a data packet.
enum class QtmComponent : std::uint32_t {
  k3d = 1,
  k3dNoLabels = 2,
  kAnalog = 3,
  kForce = 4,
  k6d = 5,
  k6dEuler = 6,
  k2d = 7,
  k2dLinearized = 8,
  k3dResiduals = 9,
  k3dNoLabelsResiduals = 10,
  k6dResiduals = 11,
  k6dEulerResiduals = 12,
  kAnalogSingle = 13,
  kImage = 14,
  kForceSingle = 15,
  kGazeVector = 16,
  kTimecode = 17,
  kSkeleton = 18,
  kEyeTracker = 19,
};

/// In the lab's axes [mm]. NaN: not seen.
struct QtmPoint {
  float position[3] = {};
  std::uint32_t id = 0;  ///< of unlabelled points: the trajectory
  float residual = 0;    ///< [mm]; 0 where the component has none
};

/// The 3D components of a frame, of versions from 1.8 on.
struct QtmData {
  std::uint64_t camera_time = 0;  ///< [us]
  std::uint32_t frame = 0;
  bool has_labelled = false, has_unlabelled = false;
  std::vector<QtmPoint> labelled;    ///< as the parameters list the labels
  std::vector<QtmPoint> unlabelled;  ///< those seen
};

/// The body of a data packet. Components of other kinds are passed over. Memory of *data is used
/// again.
/// @throws BrokenMessage; *data is then half read.
void ParseQtmData(std::string_view body, QtmData* data);

/// Appends a data packet with these components; those that QtmData has nothing of are empty.
void AppendQtmData(const QtmData& data, const std::vector<QtmComponent>& components,
                   std::string* out);

}  // namespace mmm_converter
