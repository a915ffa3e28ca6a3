// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/live/live_sinks.h"

#include <fmt/format.h>

#include <vector>

#include "MMMConverterS2KF/live/web_sink.h"
#include "common/live/mvn/mvn_sink.h"
#include "common/live/zmq/zmq_sink.h"
#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

// A row is all there is to add.
struct SinkKind {
  const char* scheme;
  std::unique_ptr<PoseSink> (*open)(const std::string& address);
  bool takes_objects;
};

const std::vector<SinkKind>& Kinds() {
  static const std::vector<SinkKind> kinds = {
      {"mvn", OpenMvnSink, false}, {"ws", OpenWebSocketSink, true}, {"zmq", OpenZmqSink, true}};
  return kinds;
}

const SinkKind& KindOf(const std::string& address) {
  for (const SinkKind& kind : Kinds()) {
    if (address.starts_with(std::string(kind.scheme) + "://")) return kind;
  }
  throw Error(
      fmt::format("{}: is no address that postures can be sent to; use {}", address, SinkKinds()));
}

}  // namespace

std::string SinkKinds() {
  std::vector<std::string> names;
  for (const SinkKind& kind : Kinds()) names.emplace_back(kind.scheme);
  return JoinNames(names);
}

std::unique_ptr<PoseSink> OpenSink(const std::string& address) {
  return KindOf(address).open(address);
}

bool TakesObjects(const std::string& address) { return KindOf(address).takes_objects; }

}  // namespace mmm_converter
