// SPDX-License-Identifier: MIT
#include <Eigen/Core>

#include "common/live/natnet/natnet_columns.h"
#include "common/live/natnet/natnet_frame.h"
#include "common/live/natnet/natnet_message.h"
#include "common/live/natnet/natnet_model.h"
#include "common/support/error.h"
#include "tests/fuzz/fuzz_target.h"

namespace mmm_converter::testing {
namespace {

void ReadFrame(std::string_view payload, const NatNetVersion& version) {
  NatNetFrame frame, again;
  ParseNatNetFrame(payload, version, &frame);
  std::string written;
  AppendNatNetFrame(frame, version, &written);
  ParseNatNetFrame(written, version, &again);
  Require(again.number == frame.number && again.markers.size() == frame.markers.size(),
          "the frame that was written");
  Eigen::Matrix3Xd points;
  NatNetModel model;
  for (const NatNetFrameMarkerSet& set : frame.marker_sets) {
    model.marker_sets.push_back({set.name, {"first", "second"}});
  }
  NatNetColumns(model, version).Fill(frame, &points);
}

void ReadModel(std::string_view payload, const NatNetVersion& version) {
  const NatNetModel model = ParseNatNetModel(payload, version);
  const NatNetModel again = ParseNatNetModel(FormatNatNetModel(model, version), version);
  Require(NatNetColumns(again, version).labels() == NatNetColumns(model, version).labels(),
          "the labels that were written");
}

/// Two bytes of the version, then a message.
void ReadMessage(std::string_view bytes) {
  if (bytes.size() < 2) throw Error("no version");
  const NatNetVersion version{bytes[0] % 8, bytes[1] % 16};
  if (version < kOldestNatNet) throw Error("too old");
  const NatNetMessage message = ParseNatNetMessage(bytes.substr(2));
  switch (message.id) {
    case NatNetId::kFrame:
      return ReadFrame(message.payload, version);
    case NatNetId::kModel:
      return ReadModel(message.payload, version);
    case NatNetId::kServerInfo:
      ParseNatNetServerInfo(FormatNatNetServerInfo(ParseNatNetServerInfo(message.payload)));
      return;
    default:
      return;
  }
}

}  // namespace

void ReadNatNetBytes(std::string_view bytes) {
  try {
    ReadMessage(bytes);
  } catch (const Error& error) {
    throw Error(std::string(kInputName) + ": " + error.what());
  }
}

}  // namespace mmm_converter::testing
