// SPDX-License-Identifier: MIT
#include "common/live/natnet/natnet_frame.h"
#include "common/live/natnet/natnet_layout.h"
#include "common/live/wire/byte_writer.h"

namespace mmm_converter {
namespace {

class FrameWriter {
 public:
  FrameWriter(const NatNetVersion& version, std::string* out) : writer_(out), version_(version) {}

  void Write(const NatNetFrame& frame) {
    writer_.Put(frame.number);
    PutSection(frame.marker_sets, [&](const NatNetFrameMarkerSet& set) {
      writer_.PutText(set.name);
      writer_.PutCount(set.positions.size());
      for (const auto& position : set.positions) PutAll(position);
    });
    PutSection(frame.other_markers, [&](const auto& position) { PutAll(position); });
    PutSection(frame.bodies, [&](const auto& body) { PutBody(body); });
    PutSection(frame.skeletons, [&](const NatNetFrameSkeleton& skeleton) {
      writer_.Put(skeleton.id);
      writer_.PutCount(skeleton.bones.size());
      for (const auto& bone : skeleton.bones) PutBody(bone);
    });
    if (version_ >= kNatNetWithSizes) {
      PutSection(frame.assets, [&](const auto& asset) { PutAsset(asset); });
    }
    PutSection(frame.markers, [&](const auto& marker) { PutMarker(marker); });
    if (version_ >= kNatNetWithForcePlates) PutSamples(frame.force_plates);
    if (version_ >= kNatNetWithDevices) PutSamples(frame.devices);
    PutSuffix(frame);
  }

 private:
  template <typename T, std::size_t n>
  void PutAll(const std::array<T, n>& values) {
    for (const T value : values) writer_.Put(value);
  }

  template <typename T, typename PutOne>
  void PutSection(const std::vector<T>& elements, const PutOne& put) {
    writer_.PutCount(elements.size());
    const bool has_size = version_ >= kNatNetWithSizes;
    const std::size_t begin = has_size ? writer_.ReserveSize() : 0;
    for (const T& element : elements) put(element);
    if (has_size) writer_.PutSizeAt(begin);
  }

  void PutBody(const NatNetFrameBody& body) {
    writer_.Put(body.id);
    PutAll(body.position);
    PutAll(body.orientation);
    if (version_ < kNatNet3) {
      writer_.PutCount(body.markers.size());
      for (const auto& marker : body.markers) PutAll(marker.position);
      for (const auto& marker : body.markers) writer_.Put(marker.id);
      for (const auto& marker : body.markers) writer_.Put(marker.size);
    }
    writer_.Put(body.error);
    if (version_ >= kNatNetWithBodyParameters) writer_.Put(body.parameters);
  }

  void PutMarker(const NatNetMarker& marker) {
    writer_.Put(marker.id);
    PutAll(marker.position);
    writer_.Put(marker.size);
    if (version_ >= kNatNetWithBodyParameters) writer_.Put(marker.parameters);
    if (version_ >= kNatNet3) writer_.Put(marker.residual);
  }

  void PutAsset(const NatNetFrameAsset& asset) {
    writer_.Put(asset.id);
    writer_.PutCount(asset.bodies.size());
    for (const auto& body : asset.bodies) PutBody(body);
    writer_.PutCount(asset.markers.size());
    for (const auto& marker : asset.markers) PutMarker(marker);
  }

  void PutSamples(const std::vector<NatNetSamples>& all) {
    PutSection(all, [&](const NatNetSamples& samples) {
      writer_.Put(samples.id);
      writer_.PutCount(samples.channels.size());
      for (const auto& channel : samples.channels) {
        writer_.PutCount(channel.size());
        for (const float value : channel) writer_.Put(value);
      }
    });
  }

  void PutSuffix(const NatNetFrame& frame) {
    if (version_ < kNatNet3) writer_.Put(frame.latency);
    writer_.Put(frame.timecode);
    writer_.Put(frame.timecode_subframe);
    if (version_ >= kNatNetWithExactTime) {
      writer_.Put(frame.time);
    } else if (version_ >= kNatNetWithBodyParameters) {
      writer_.Put(static_cast<float>(frame.time));
    }
    if (version_ >= kNatNet3) {
      for (const std::uint64_t ticks : {frame.exposed, frame.received, frame.sent}) {
        writer_.Put(ticks);
      }
    }
    if (version_ >= kNatNetWithSizes) {
      writer_.Put(frame.precise_seconds);
      writer_.Put(frame.precise_fraction);
    }
    if (version_ >= kNatNetWithBodyParameters) writer_.Put(frame.parameters);
    writer_.Put(std::int32_t{0});
  }

  ByteWriter writer_;
  const NatNetVersion& version_;
};

}  // namespace

void AppendNatNetFrame(const NatNetFrame& frame, const NatNetVersion& version, std::string* out) {
  FrameWriter(version, out).Write(frame);
}

}  // namespace mmm_converter
