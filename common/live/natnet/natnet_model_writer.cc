// SPDX-License-Identifier: MIT
#include "common/live/natnet/natnet_layout.h"
#include "common/live/natnet/natnet_model.h"
#include "common/live/wire/byte_writer.h"

namespace mmm_converter {
namespace {

template <typename T, std::size_t n>
void PutArray(ByteWriter* writer, const std::array<T, n>& values) {
  for (const T value : values) writer->Put(value);
}

void PutNames(ByteWriter* writer, const std::vector<std::string>& names) {
  writer->PutCount(names.size());
  for (const std::string& name : names) writer->PutText(name);
}

void PutBody(ByteWriter* writer, const NatNetBody& body, const NatNetVersion& version) {
  writer->PutText(body.name);
  writer->Put(body.id);
  writer->Put(body.parent);
  PutArray(writer, body.offset);
  if (version >= kNatNetWithBodyRotation) PutArray(writer, body.rotation);
  if (version < kNatNet3) return;
  writer->PutCount(body.markers.size());
  for (const NatNetBodyMarker& marker : body.markers) PutArray(writer, marker.position);
  for (const NatNetBodyMarker& marker : body.markers) writer->Put(marker.active_label);
  if (version < kNatNet4) return;
  for (const NatNetBodyMarker& marker : body.markers) writer->PutText(marker.name);
}

void PutBodies(ByteWriter* writer, const std::vector<NatNetBody>& bodies,
               const NatNetVersion& version) {
  writer->PutCount(bodies.size());
  for (const NatNetBody& body : bodies) PutBody(writer, body, version);
}

void PutForcePlate(ByteWriter* writer, const NatNetForcePlate& plate) {
  writer->Put(plate.id);
  writer->PutText(plate.serial);
  PutArray(writer, plate.size);
  PutArray(writer, plate.origin);
  PutArray(writer, plate.calibration);
  PutArray(writer, plate.corners);
  writer->Put(plate.plate_type);
  writer->Put(plate.data_type);
  PutNames(writer, plate.channels);
}

void PutDevice(ByteWriter* writer, const NatNetDevice& device) {
  writer->Put(device.id);
  writer->PutText(device.name);
  writer->PutText(device.serial);
  writer->Put(device.type);
  writer->Put(device.data_type);
  PutNames(writer, device.channels);
}

void PutAsset(ByteWriter* writer, const NatNetAsset& asset, const NatNetVersion& version) {
  writer->PutText(asset.name);
  writer->Put(asset.type);
  writer->Put(asset.id);
  PutBodies(writer, asset.bodies, version);
  writer->PutCount(asset.markers.size());
  for (const NatNetAssetMarker& marker : asset.markers) {
    writer->PutText(marker.name);
    writer->Put(marker.id);
    PutArray(writer, marker.position);
    writer->Put(marker.size);
    writer->Put(marker.parameters);
  }
}

/// Puts a list of descriptions of one type.
class DescriptionWriter {
 public:
  DescriptionWriter(ByteWriter* writer, const NatNetVersion& version)
      : writer_(writer), has_sizes_(version >= kNatNetWithSizes) {}

  template <typename T, typename Put>
  void PutAll(std::int32_t type, const std::vector<T>& elements, const Put& put) {
    for (const T& element : elements) {
      writer_->Put(type);
      const std::size_t begin = has_sizes_ ? writer_->ReserveSize() : 0;
      put(element);
      if (has_sizes_) writer_->PutSizeAt(begin);
      ++count_;
    }
  }

  std::uint32_t count() const { return count_; }

 private:
  ByteWriter* writer_;
  bool has_sizes_;
  std::uint32_t count_ = 0;
};

}  // namespace

std::string FormatNatNetModel(const NatNetModel& model, const NatNetVersion& version) {
  std::string descriptions;
  ByteWriter writer(&descriptions);
  DescriptionWriter all(&writer, version);
  all.PutAll(0, model.marker_sets, [&](const NatNetMarkerSet& set) {
    writer.PutText(set.name);
    PutNames(&writer, set.markers);
  });
  all.PutAll(1, model.bodies, [&](const NatNetBody& body) { PutBody(&writer, body, version); });
  all.PutAll(2, model.skeletons, [&](const NatNetSkeleton& skeleton) {
    writer.PutText(skeleton.name);
    writer.Put(skeleton.id);
    PutBodies(&writer, skeleton.bones, version);
  });
  if (version >= kNatNetWithForcePlates) {
    all.PutAll(3, model.force_plates,
               [&](const NatNetForcePlate& plate) { PutForcePlate(&writer, plate); });
  }
  if (version >= kNatNetWithDevices) {
    all.PutAll(4, model.devices, [&](const NatNetDevice& device) { PutDevice(&writer, device); });
  }
  if (version >= kNatNet3) {
    all.PutAll(5, model.cameras, [&](const NatNetCamera& camera) {
      writer.PutText(camera.name);
      PutArray(&writer, camera.position);
      PutArray(&writer, camera.orientation);
    });
  }
  if (version >= kNatNetWithSizes) {
    all.PutAll(6, model.assets,
               [&](const NatNetAsset& asset) { PutAsset(&writer, asset, version); });
  }
  std::string payload;
  ByteWriter(&payload).Put(all.count());
  return payload + descriptions;
}

}  // namespace mmm_converter
