// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/live/natnet/natnet_message.h"

namespace mmm_converter {

// A frame of a NatNet server. Positions in metres, quaternions x y z w, in the axes that the server
// streams in: y up unless its user has chosen z.

struct NatNetFrameMarkerSet {
  std::string name;
  std::vector<std::array<float, 3>> positions;  ///< as the model lists the markers
};

struct NatNetFrameBodyMarker {
  std::array<float, 3> position = {};
  std::int32_t id = 0;
  float size = 0;
};

struct NatNetFrameBody {
  std::int32_t id = 0;  ///< of a bone: skeleton in the high word, bone in the low word
  std::array<float, 3> position = {};
  std::array<float, 4> orientation = {};
  std::vector<NatNetFrameBodyMarker> markers;  ///< before 3.0
  float error = 0;
  std::int16_t parameters = 0;  ///< from 2.6 on; bit 0: is tracked
};

struct NatNetFrameSkeleton {
  std::int32_t id = 0;
  std::vector<NatNetFrameBody> bones;
};

/// From 2.6 on, but for the ids.
enum NatNetMarkerBits : std::int16_t {
  kNatNetOccluded = 0x01,
  kNatNetSolved = 0x02,       ///< from what cameras saw
  kNatNetModelFilled = 0x04,  ///< from where the others are
  kNatNetHasModel = 0x08,
  kNatNetUnlabelled = 0x10,  ///< from 3.0 on
  kNatNetActive = 0x20,
};

struct NatNetMarker {
  std::int32_t id = 0;  ///< asset in the high word, member from 1 on in the low word
  std::array<float, 3> position = {};
  float size = 0;
  std::int16_t parameters = 0;  ///< NatNetMarkerBits
  float residual = 0;           ///< from 3.0 on [m]
};

/// From 4.1 on.
struct NatNetFrameAsset {
  std::int32_t id = 0;
  std::vector<NatNetFrameBody> bodies;
  std::vector<NatNetMarker> markers;
};

/// Force plates and devices.
struct NatNetSamples {
  std::int32_t id = 0;
  std::vector<std::vector<float>> channels;
};

enum NatNetFrameBits : std::int16_t {
  kNatNetRecording = 0x01,
  kNatNetModelChanged = 0x02,
  kNatNetLive = 0x04,
  kNatNetVersionChanged = 0x08,
};

struct NatNetFrame {
  std::int32_t number = 0;
  std::vector<NatNetFrameMarkerSet> marker_sets;
  std::vector<std::array<float, 3>> other_markers;
  std::vector<NatNetFrameBody> bodies;
  std::vector<NatNetFrameSkeleton> skeletons;
  std::vector<NatNetFrameAsset> assets;
  std::vector<NatNetMarker> markers;  ///< labelled ones, and from 3.0 on unlabelled ones too
  std::vector<NatNetSamples> force_plates, devices;
  float latency = 0;  ///< before 3.0
  std::uint32_t timecode = 0, timecode_subframe = 0;
  double time = 0;  ///< from 2.6 on: since the server's start [s]
  // From 3.0 on, in ticks of its clock:
  std::uint64_t exposed = 0, received = 0, sent = 0;
  std::uint32_t precise_seconds = 0, precise_fraction = 0;  ///< from 4.1 on
  std::int16_t parameters = 0;                              ///< NatNetFrameBits, from 2.6 on
};

/// The payload of a frame in the layout of a version. Memory of *frame is used again.
/// @throws BrokenMessage, also where bytes are left; *frame is then half read.
void ParseNatNetFrame(std::string_view payload, const NatNetVersion& version, NatNetFrame* frame);

/// Appends the payload. What the version has no place for is left out.
void AppendNatNetFrame(const NatNetFrame& frame, const NatNetVersion& version, std::string* out);

}  // namespace mmm_converter
