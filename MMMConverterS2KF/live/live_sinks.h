// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include "common/live/pose_sink.h"

namespace mmm_converter {

/// The sink of an address such as mvn://host:port. @throws Error naming the kinds that there are.
std::unique_ptr<PoseSink> OpenSink(const std::string& address);

/// Whether a sink of such an address takes rigid objects beside a person. @throws Error as
/// OpenSink.
bool TakesObjects(const std::string& address);

/// "mvn, ws or zmq", for help texts.
std::string SinkKinds();

}  // namespace mmm_converter
