// SPDX-License-Identifier: MIT
#include "common/live/natnet/natnet_model.h"

#include <fmt/format.h>

#include "common/live/natnet/natnet_layout.h"
#include "common/live/wire/byte_reader.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

enum DescriptionType : std::int32_t {
  kMarkerSetType = 0,
  kBodyType = 1,
  kSkeletonType = 2,
  kForcePlateType = 3,
  kDeviceType = 4,
  kCameraType = 5,
  kAssetType = 6,
};

// The fewest bytes of an element in a list.
constexpr std::size_t kLeastText = 1;
constexpr std::size_t kLeastBody = 21;
constexpr std::size_t kLeastAssetMarker = 23;
constexpr std::size_t kLeastDescription = 4;

template <typename T, std::size_t n>
void TakeArray(ByteReader* reader, std::array<T, n>* values) {
  for (T& value : *values) value = reader->Take<T>();
}

std::string TakeName(ByteReader* reader) { return ToUtf8(reader->TakeText()); }

void TakeNames(ByteReader* reader, std::vector<std::string>* names) {
  names->resize(reader->TakeCount(kLeastText));
  for (std::string& name : *names) name = TakeName(reader);
}

NatNetBody TakeBody(ByteReader* reader, const NatNetVersion& version) {
  NatNetBody body;
  body.name = TakeName(reader);
  body.id = reader->Take<std::int32_t>();
  body.parent = reader->Take<std::int32_t>();
  TakeArray(reader, &body.offset);
  if (version >= kNatNetWithBodyRotation) TakeArray(reader, &body.rotation);
  if (version < kNatNet3) return body;
  body.markers.resize(reader->TakeCount(16));
  for (NatNetBodyMarker& marker : body.markers) TakeArray(reader, &marker.position);
  for (NatNetBodyMarker& marker : body.markers) {
    marker.active_label = reader->Take<std::int32_t>();
  }
  if (version < kNatNet4) return body;
  for (NatNetBodyMarker& marker : body.markers) marker.name = TakeName(reader);
  return body;
}

std::vector<NatNetBody> TakeBodies(ByteReader* reader, const NatNetVersion& version) {
  std::vector<NatNetBody> bodies;
  const std::size_t count = reader->TakeCount(kLeastBody);
  for (std::size_t i = 0; i < count; ++i) bodies.push_back(TakeBody(reader, version));
  return bodies;
}

NatNetForcePlate TakeForcePlate(ByteReader* reader) {
  NatNetForcePlate plate;
  plate.id = reader->Take<std::int32_t>();
  plate.serial = TakeName(reader);
  TakeArray(reader, &plate.size);
  TakeArray(reader, &plate.origin);
  TakeArray(reader, &plate.calibration);
  TakeArray(reader, &plate.corners);
  plate.plate_type = reader->Take<std::int32_t>();
  plate.data_type = reader->Take<std::int32_t>();
  TakeNames(reader, &plate.channels);
  return plate;
}

NatNetDevice TakeDevice(ByteReader* reader) {
  NatNetDevice device;
  device.id = reader->Take<std::int32_t>();
  device.name = TakeName(reader);
  device.serial = TakeName(reader);
  device.type = reader->Take<std::int32_t>();
  device.data_type = reader->Take<std::int32_t>();
  TakeNames(reader, &device.channels);
  return device;
}

NatNetAsset TakeAsset(ByteReader* reader, const NatNetVersion& version) {
  NatNetAsset asset;
  asset.name = TakeName(reader);
  asset.type = reader->Take<std::int32_t>();
  asset.id = reader->Take<std::int32_t>();
  asset.bodies = TakeBodies(reader, version);
  asset.markers.resize(reader->TakeCount(kLeastAssetMarker));
  for (NatNetAssetMarker& marker : asset.markers) {
    marker.name = TakeName(reader);
    marker.id = reader->Take<std::int32_t>();
    TakeArray(reader, &marker.position);
    marker.size = reader->Take<float>();
    marker.parameters = reader->Take<std::int16_t>();
  }
  return asset;
}

NatNetCamera TakeCamera(ByteReader* reader) {
  NatNetCamera camera;
  camera.name = TakeName(reader);
  TakeArray(reader, &camera.position);
  TakeArray(reader, &camera.orientation);
  return camera;
}

NatNetMarkerSet TakeMarkerSet(ByteReader* reader) {
  NatNetMarkerSet set;
  set.name = TakeName(reader);
  TakeNames(reader, &set.markers);
  return set;
}

NatNetSkeleton TakeSkeleton(ByteReader* reader, const NatNetVersion& version) {
  NatNetSkeleton skeleton;
  skeleton.name = TakeName(reader);
  skeleton.id = reader->Take<std::int32_t>();
  skeleton.bones = TakeBodies(reader, version);
  return skeleton;
}

/// false: of a type that the version does not have.
bool TakeDescription(std::int32_t type, ByteReader* reader, const NatNetVersion& version,
                     NatNetModel* model) {
  switch (type) {
    case kMarkerSetType:
      model->marker_sets.push_back(TakeMarkerSet(reader));
      return true;
    case kBodyType:
      model->bodies.push_back(TakeBody(reader, version));
      return true;
    case kSkeletonType:
      model->skeletons.push_back(TakeSkeleton(reader, version));
      return true;
    case kForcePlateType:
      model->force_plates.push_back(TakeForcePlate(reader));
      return true;
    case kDeviceType:
      model->devices.push_back(TakeDevice(reader));
      return true;
    case kCameraType:
      model->cameras.push_back(TakeCamera(reader));
      return true;
    case kAssetType:
      if (version < kNatNetWithSizes) return false;
      model->assets.push_back(TakeAsset(reader, version));
      return true;
    default:
      return false;
  }
}

}  // namespace

NatNetModel ParseNatNetModel(std::string_view payload, const NatNetVersion& version) {
  NatNetModel model;
  ByteReader reader(payload);
  const bool has_sizes = version >= kNatNetWithSizes;
  const std::size_t count = reader.TakeCount(kLeastDescription);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t where = reader.at();
    const auto type = reader.Take<std::int32_t>();
    const std::size_t size = has_sizes ? reader.TakeCount(1) : 0;
    const std::size_t begin = reader.at();
    if (TakeDescription(type, &reader, version, &model)) {
      // A version that comes may have more at the end of a description.
      if (version > kNewestNatNet && begin + size > reader.at()) reader.GoTo(begin + size);
    } else if (has_sizes) {
      reader.GoTo(begin + size);
    } else {
      reader.GoTo(where);
      reader.Fail(fmt::format("a description of the unknown type {}", type));
    }
  }
  reader.ExpectEnd();
  return model;
}

}  // namespace mmm_converter
