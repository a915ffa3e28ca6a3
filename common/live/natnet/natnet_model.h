// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/live/natnet/natnet_message.h"

namespace mmm_converter {

// What the model definition of a NatNet server describes. Lengths in metres.

struct NatNetMarkerSet {
  std::string name;
  std::vector<std::string> markers;
};

struct NatNetBodyMarker {
  std::array<float, 3> position = {};  ///< in the body
  std::int32_t active_label = 0;
  std::string name;  ///< from 4.0 on
};

struct NatNetBody {
  std::string name;
  std::int32_t id = 0;
  std::int32_t parent = -1;               ///< -1: none
  std::array<float, 3> offset = {};       ///< from the parent
  std::array<float, 4> rotation = {};     ///< from 4.2 on
  std::vector<NatNetBodyMarker> markers;  ///< from 3.0 on
};

struct NatNetSkeleton {
  std::string name;
  std::int32_t id = 0;
  std::vector<NatNetBody> bones;
};

struct NatNetForcePlate {
  std::int32_t id = 0;
  std::string serial;
  std::array<float, 2> size = {};
  std::array<float, 3> origin = {};
  std::array<float, 144> calibration = {};
  std::array<float, 12> corners = {};
  std::int32_t plate_type = 0, data_type = 0;
  std::vector<std::string> channels;
};

struct NatNetDevice {
  std::int32_t id = 0;
  std::string name, serial;
  std::int32_t type = 0, data_type = 0;
  std::vector<std::string> channels;
};

struct NatNetCamera {
  std::string name;
  std::array<float, 3> position = {};
  std::array<float, 4> orientation = {};
};

struct NatNetAssetMarker {
  std::string name;
  std::int32_t id = 0;
  std::array<float, 3> position = {};
  float size = 0;
  std::int16_t parameters = 0;
};

/// A trained marker set.
struct NatNetAsset {
  std::string name;
  std::int32_t type = 0, id = 0;
  std::vector<NatNetBody> bodies;
  std::vector<NatNetAssetMarker> markers;
};

struct NatNetModel {
  std::vector<NatNetMarkerSet> marker_sets;
  std::vector<NatNetBody> bodies;
  std::vector<NatNetSkeleton> skeletons;
  std::vector<NatNetForcePlate> force_plates;
  std::vector<NatNetDevice> devices;
  std::vector<NatNetCamera> cameras;
  std::vector<NatNetAsset> assets;
};

/// The payload of a model definition in the layout of a version. From 4.1 on descriptions of types
/// that are not known are passed over.
/// @throws BrokenMessage, also where bytes are left.
NatNetModel ParseNatNetModel(std::string_view payload, const NatNetVersion& version);

/// What the version has no description of is left out.
std::string FormatNatNetModel(const NatNetModel& model, const NatNetVersion& version);

}  // namespace mmm_converter
