// SPDX-License-Identifier: MIT
#include "common/live/socket_address.h"

#include <fmt/format.h>

#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {

SocketAddress ParseSocketAddress(const std::string& text, const std::string& default_host,
                                 int default_port) {
  const std::size_t scheme = text.find("://");
  std::string rest = scheme == std::string::npos ? text : text.substr(scheme + 3);
  while (!rest.empty() && rest.back() == '/') rest.pop_back();
  const std::size_t bracket = rest.rfind(']');
  const std::size_t colon = rest.rfind(':');
  SocketAddress address = {rest, default_port};
  if (colon != std::string::npos && (bracket == std::string::npos || colon > bracket)) {
    const auto port = ParseLong(rest.substr(colon + 1));
    if (!port || *port < 0 || *port > 65535) {
      throw Error(fmt::format("{}: \"{}\" is no port; give a number from 0 to 65535", text,
                              rest.substr(colon + 1)));
    }
    address = {rest.substr(0, colon), static_cast<int>(*port)};
  }
  if (address.host.starts_with('[') && address.host.ends_with(']')) {
    address.host = address.host.substr(1, address.host.size() - 2);
  }
  if (address.host.empty()) address.host = default_host;
  return address;
}

}  // namespace mmm_converter
