// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace mmm_converter {

/// SCHEME://HOST:PORT?NAME=VALUE&NAME=VALUE; all behind the scheme may be left out.
struct StreamAddress {
  std::string text;  ///< as given
  std::string scheme;
  std::string host;         ///< empty: not given
  std::optional<int> port;  ///< 1 to 65535
  std::map<std::string, std::string> options;

  std::string HostOr(const std::string& otherwise) const { return host.empty() ? otherwise : host; }
  std::optional<std::string> Get(const std::string& option) const;
  std::optional<int> GetPort(const std::string& option) const;
  /// "yes" or nothing behind the name: true, "no": false.
  bool GetSwitch(const std::string& option) const;
  /// @throws Error for an option that is none of these.
  void AllowOnly(const std::vector<std::string>& names) const;
};

/// @throws Error naming the address and what is wrong; also what StreamAddress throws.
StreamAddress ParseStreamAddress(const std::string& text);

/// A host as it stands in an address: IPv6 in brackets.
std::string InAddress(const std::string& host);

}  // namespace mmm_converter
