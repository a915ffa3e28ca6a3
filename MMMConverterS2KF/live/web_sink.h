// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include "common/live/pose_sink.h"

namespace mmm_converter {

/// Serves postures as JSON to WebSocket clients. address: "ws://host:port"; without a port 9002.
/// @throws Error where it can't listen there.
std::unique_ptr<PoseSink> OpenWebSocketSink(const std::string& address);

/// A page that shows them, behind a path that nobody can guess, and where it is.
struct LivePage {
  std::unique_ptr<PoseSink> sink;
  std::string address;  ///< for a browser: "http://127.0.0.1:40001/3fa9.../"
};
/// at: "host:port"; empty: loopback and a free port. title: of the page.
/// @throws Error where it can't listen there.
LivePage OpenLivePage(const std::string& at, const std::string& title);

}  // namespace mmm_converter
