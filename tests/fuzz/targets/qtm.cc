// SPDX-License-Identifier: MIT
#include "common/live/qtm/qtm_data.h"
#include "common/live/qtm/qtm_packet.h"
#include "common/live/qtm/qtm_parameters.h"
#include "common/support/error.h"
#include "tests/fuzz/fuzz_target.h"

namespace mmm_converter::testing {
namespace {

void ReadData(std::string_view body) {
  QtmData data, again;
  ParseQtmData(body, &data);
  std::string written;
  AppendQtmData(data, {QtmComponent::k3dResiduals, QtmComponent::k3dNoLabelsResiduals}, &written);
  ParseQtmData(ParseQtmPacket(written).body, &again);
  Require(again.frame == data.frame && again.labelled.size() == data.labelled.size() &&
              again.unlabelled.size() == data.unlabelled.size(),
          "the data that was written");
}

void ReadParameters(std::string_view xml) {
  const QtmParameters read = ParseQtmParameters(xml);
  const QtmParameters again =
      ParseQtmParameters(FormatQtmParameters(read, {.general = true, .the_3d = true}, 25));
  Require(again.labels.size() == read.labels.size(), "the labels that were written");
}

void ReadPacket(std::string_view bytes) {
  QtmPacketSize(bytes);
  const QtmPacket packet = ParseQtmPacket(bytes);
  switch (packet.type) {
    case QtmPacketType::kData:
      return ReadData(packet.body);
    case QtmPacketType::kXml:
      return ReadParameters(QtmText(packet));
    case QtmPacketType::kEvent:
      ParseQtmEvent(packet);
      return;
    case QtmPacketType::kDiscover:
      ParseQtmDiscovery(bytes);
      return;
    default:
      QtmText(packet);
  }
}

}  // namespace

void ReadQtmBytes(std::string_view bytes) {
  try {
    ReadPacket(bytes);
  } catch (const Error& error) {
    throw Error(std::string(kInputName) + ": " + error.what());
  }
}

}  // namespace mmm_converter::testing
