// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace mmm_converter {

struct SocketAddress {
  std::string host;
  int port = 0;
};

/// "HOST:PORT", also behind a scheme such as "mvn://", and with an IPv6 host in brackets. Of an
/// empty host `default_host` is taken, of a missing port default_port.
/// @throws Error quoting the text where the port is none.
SocketAddress ParseSocketAddress(const std::string& text, const std::string& default_host,
                                 int default_port);

}  // namespace mmm_converter
