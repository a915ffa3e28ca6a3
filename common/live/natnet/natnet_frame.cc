// SPDX-License-Identifier: MIT
#include "common/live/natnet/natnet_frame.h"

#include <fmt/format.h>

#include "common/live/natnet/natnet_layout.h"
#include "common/live/wire/byte_reader.h"

namespace mmm_converter {
namespace {

class FrameReader {
 public:
  FrameReader(std::string_view payload, const NatNetVersion& version)
      : reader_(payload), version_(version) {}

  void Read(NatNetFrame* frame) {
    frame->number = reader_.Take<std::int32_t>();
    TakeSection(5, &frame->marker_sets, [&](auto* set) { TakeMarkerSet(set); });
    TakeSection(12, &frame->other_markers, [&](auto* position) { TakeArray(position); });
    TakeSection(32, &frame->bodies, [&](auto* body) { TakeBody(body); });
    TakeSection(8, &frame->skeletons, [&](auto* skeleton) {
      skeleton->id = reader_.Take<std::int32_t>();
      TakeList(32, &skeleton->bones, [&](auto* body) { TakeBody(body); });
    });
    frame->assets.resize(version_ >= kNatNetWithSizes ? frame->assets.size() : 0);
    if (version_ >= kNatNetWithSizes) {
      TakeSection(12, &frame->assets, [&](auto* asset) { TakeAsset(asset); });
    }
    TakeSection(20, &frame->markers, [&](auto* marker) { TakeMarker(marker); });
    TakeSamples(kNatNetWithForcePlates, &frame->force_plates);
    TakeSamples(kNatNetWithDevices, &frame->devices);
    TakeSuffix(frame);
  }

 private:
  template <typename T, std::size_t n>
  void TakeArray(std::array<T, n>* values) {
    for (T& value : *values) value = reader_.Take<T>();
  }

  template <typename T, typename TakeOne>
  void TakeList(std::size_t least_bytes, std::vector<T>* elements, const TakeOne& take) {
    elements->resize(reader_.TakeCount(least_bytes));
    for (T& element : *elements) take(&element);
  }

  /// A list with its size in bytes between its count and its elements, from 4.1 on. The elements'
  /// own sizes count; of a version that comes the section's does.
  template <typename T, typename TakeOne>
  void TakeSection(std::size_t least_bytes, std::vector<T>* elements, const TakeOne& take) {
    elements->resize(reader_.TakeCount(least_bytes));
    const auto size = version_ >= kNatNetWithSizes ? reader_.Take<std::uint32_t>() : 0U;
    const std::size_t begin = reader_.at();
    const std::size_t left = reader_.left();
    for (T& element : *elements) take(&element);
    if (version_ > kNewestNatNet && size <= left && begin + size > reader_.at()) {
      reader_.GoTo(begin + size);
    }
  }

  void TakeMarkerSet(NatNetFrameMarkerSet* set) {
    set->name = reader_.TakeText();
    TakeList(12, &set->positions, [&](auto* position) { TakeArray(position); });
  }

  void TakeBody(NatNetFrameBody* body) {
    body->id = reader_.Take<std::int32_t>();
    TakeArray(&body->position);
    TakeArray(&body->orientation);
    body->markers.clear();
    if (version_ < kNatNet3) {
      TakeList(20, &body->markers, [&](auto* marker) { TakeArray(&marker->position); });
      for (auto& marker : body->markers) marker.id = reader_.Take<std::int32_t>();
      for (auto& marker : body->markers) marker.size = reader_.Take<float>();
    }
    body->error = reader_.Take<float>();
    body->parameters =
        version_ >= kNatNetWithBodyParameters ? reader_.Take<std::int16_t>() : std::int16_t{0};
  }

  void TakeMarker(NatNetMarker* marker) {
    marker->id = reader_.Take<std::int32_t>();
    TakeArray(&marker->position);
    marker->size = reader_.Take<float>();
    marker->parameters =
        version_ >= kNatNetWithBodyParameters ? reader_.Take<std::int16_t>() : std::int16_t{0};
    marker->residual = version_ >= kNatNet3 ? reader_.Take<float>() : 0.0F;
  }

  void TakeAsset(NatNetFrameAsset* asset) {
    asset->id = reader_.Take<std::int32_t>();
    TakeList(38, &asset->bodies, [&](auto* body) { TakeBody(body); });
    TakeList(26, &asset->markers, [&](auto* marker) { TakeMarker(marker); });
  }

  void TakeSamples(const NatNetVersion& since, std::vector<NatNetSamples>* all) {
    if (version_ < since) {
      all->clear();
      return;
    }
    TakeSection(8, all, [&](auto* samples) {
      samples->id = reader_.Take<std::int32_t>();
      TakeList(4, &samples->channels, [&](auto* channel) {
        TakeList(4, channel, [&](auto* value) { *value = reader_.Take<float>(); });
      });
    });
  }

  void TakeSuffix(NatNetFrame* frame) {
    frame->latency = version_ < kNatNet3 ? reader_.Take<float>() : 0.0F;
    frame->timecode = reader_.Take<std::uint32_t>();
    frame->timecode_subframe = reader_.Take<std::uint32_t>();
    frame->time = 0;
    frame->exposed = frame->received = frame->sent = 0;
    frame->precise_seconds = frame->precise_fraction = 0;
    if (version_ >= kNatNetWithExactTime) {
      frame->time = reader_.Take<double>();
    } else if (version_ >= kNatNetWithBodyParameters) {
      frame->time = reader_.Take<float>();
    }
    if (version_ >= kNatNet3) {
      frame->exposed = reader_.Take<std::uint64_t>();
      frame->received = reader_.Take<std::uint64_t>();
      frame->sent = reader_.Take<std::uint64_t>();
    }
    if (version_ >= kNatNetWithSizes) {
      frame->precise_seconds = reader_.Take<std::uint32_t>();
      frame->precise_fraction = reader_.Take<std::uint32_t>();
    }
    frame->parameters =
        version_ >= kNatNetWithBodyParameters ? reader_.Take<std::int16_t>() : std::int16_t{0};
    if (version_ > kNewestNatNet) return;  // which may have more here
    if (reader_.Take<std::int32_t>() != 0) reader_.Fail("no mark of the frame's end before it");
    reader_.ExpectEnd();
  }

  ByteReader reader_;
  const NatNetVersion& version_;
};

}  // namespace

void ParseNatNetFrame(std::string_view payload, const NatNetVersion& version, NatNetFrame* frame) {
  FrameReader(payload, version).Read(frame);
}

}  // namespace mmm_converter
