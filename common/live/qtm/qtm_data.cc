// SPDX-License-Identifier: MIT
#include "common/live/qtm/qtm_data.h"

#include <fmt/format.h>

#include "common/live/qtm/qtm_packet.h"
#include "common/live/wire/byte_reader.h"
#include "common/live/wire/byte_writer.h"

namespace mmm_converter {
namespace {

constexpr std::size_t kComponentHeaderBytes = 8;

/// What the points of a component have beside three coordinates.
struct PointLayout {
  bool labelled = false, id = false, residual = false;
  std::size_t bytes() const { return 12 + (id ? 4 : 0) + (residual ? 4 : 0); }
};

bool FindLayout(QtmComponent component, PointLayout* layout) {
  switch (component) {
    case QtmComponent::k3d:
      *layout = {true, false, false};
      return true;
    case QtmComponent::k3dResiduals:
      *layout = {true, false, true};
      return true;
    case QtmComponent::k3dNoLabels:
      *layout = {false, true, false};
      return true;
    case QtmComponent::k3dNoLabelsResiduals:
      *layout = {false, true, true};
      return true;
    default:
      return false;
  }
}

void TakePoints(const PointLayout& layout, ByteReader* reader, std::vector<QtmPoint>* points) {
  const auto count = reader->Take<std::uint32_t>();
  reader->TakeBytes(4);  // rates of 2D drops and out of sync
  if (reader->left() / layout.bytes() != count || reader->left() % layout.bytes() != 0) {
    reader->Fail(
        fmt::format("{} bytes for {} points of {} bytes", reader->left(), count, layout.bytes()));
  }
  points->resize(count);
  for (QtmPoint& point : *points) {
    reader->TakeArray(point.position);
    point.id = layout.id ? reader->Take<std::uint32_t>() : 0;
    point.residual = layout.residual ? reader->Take<float>() : 0;
  }
}

void PutPoints(const PointLayout& layout, const std::vector<QtmPoint>& points, ByteWriter* writer) {
  writer->PutCount(points.size());
  writer->PutCount(0);
  for (const QtmPoint& point : points) {
    const bool is_seen = point.position[0] == point.position[0];
    for (const float value : point.position) {
      // All bits are set where a point is not seen.
      is_seen ? writer->Put(value) : writer->Put(~std::uint32_t{0});
    }
    if (layout.id) writer->Put(point.id);
    if (layout.residual) {
      is_seen ? writer->Put(point.residual) : writer->Put(~std::uint32_t{0});
    }
  }
}

/// Whether two rates follow the count of a component.
bool HasRates(QtmComponent component) {
  switch (component) {
    case QtmComponent::k2d:
    case QtmComponent::k2dLinearized:
    case QtmComponent::k6d:
    case QtmComponent::k6dEuler:
    case QtmComponent::k6dResiduals:
    case QtmComponent::k6dEulerResiduals:
      return true;
    default:
      return false;
  }
}

}  // namespace

void ParseQtmData(std::string_view body, QtmData* data) {
  ByteReader reader(body);
  data->has_labelled = data->has_unlabelled = false;
  data->labelled.clear();
  data->unlabelled.clear();
  data->camera_time = reader.Take<std::uint64_t>();
  data->frame = reader.Take<std::uint32_t>();
  const std::size_t count = reader.TakeCount(kComponentHeaderBytes);
  for (std::size_t i = 0; i < count; ++i) {
    const auto size = reader.Take<std::uint32_t>();
    const auto type = static_cast<QtmComponent>(reader.Take<std::uint32_t>());
    if (size < kComponentHeaderBytes) reader.Fail(fmt::format("a component of {} bytes", size));
    ByteReader component(reader.TakeBytes(size - kComponentHeaderBytes));
    PointLayout layout;
    if (!FindLayout(type, &layout)) continue;
    (layout.labelled ? data->has_labelled : data->has_unlabelled) = true;
    TakePoints(layout, &component, layout.labelled ? &data->labelled : &data->unlabelled);
  }
  reader.ExpectEnd();
}

void AppendQtmData(const QtmData& data, const std::vector<QtmComponent>& components,
                   std::string* out) {
  ByteWriter writer(out);
  const std::size_t packet = writer.ReserveSize();
  writer.Put(static_cast<std::uint32_t>(QtmPacketType::kData));
  writer.Put(data.camera_time);
  writer.Put(data.frame);
  writer.PutCount(components.size());
  for (const QtmComponent component : components) {
    const std::size_t begin = writer.ReserveSize();
    writer.Put(static_cast<std::uint32_t>(component));
    PointLayout layout;
    if (FindLayout(component, &layout)) {
      PutPoints(layout, layout.labelled ? data.labelled : data.unlabelled, &writer);
    } else {
      writer.PutCount(0);
      if (HasRates(component)) writer.PutCount(0);
    }
    writer.PutSizeAt(begin, sizeof(std::uint32_t));
  }
  writer.PutSizeAt(packet, sizeof(std::uint32_t));
}

}  // namespace mmm_converter
