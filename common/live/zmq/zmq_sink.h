// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include "common/live/pose_sink.h"

namespace mmm_converter {

/// A ZeroMQ publisher; common/live/README.md describes its messages. address: "zmq://host:port";
/// without a port 5556. Nobody has to listen; who is too slow loses messages.
/// @throws Error where it can't listen there.
std::unique_ptr<PoseSink> OpenZmqSink(const std::string& address);

}  // namespace mmm_converter
