// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include "common/live/pose_sink.h"

namespace mmm_converter {

/// Sends poses of MVN's 23 segments over UDP. address: "mvn://host:port"; without a port MVN's,
/// 9763.
/// @throws Error where there is no such host.
std::unique_ptr<PoseSink> OpenMvnSink(const std::string& address);

}  // namespace mmm_converter
