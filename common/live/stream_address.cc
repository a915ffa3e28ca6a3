// SPDX-License-Identifier: MIT
#include "common/live/stream_address.h"

#include <fmt/format.h>

#include <algorithm>

#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

int ParsePort(const std::string& address, const std::string& text) {
  const auto port = ParseLong(text);
  if (!port || *port < 1 || *port > 65535) {
    throw Error(fmt::format("{}: the port is \"{}\"; ports are 1 to 65535", address, text));
  }
  return static_cast<int>(*port);
}

void ParseHostAndPort(std::string text, StreamAddress* address) {
  while (!text.empty() && text.back() == '/') text.pop_back();
  std::size_t colon = text.rfind(':');
  if (text.starts_with('[')) {  // [::1]:22223
    const std::size_t end = text.find(']');
    if (end == std::string::npos) {
      throw Error(fmt::format("{}: the host \"{}\" has no closing ]", address->text, text));
    }
    address->host = text.substr(1, end - 1);
    colon = end + 1 < text.size() ? end + 1 : std::string::npos;
  } else {
    address->host = text.substr(0, colon);
  }
  if (colon != std::string::npos) address->port = ParsePort(address->text, text.substr(colon + 1));
}

}  // namespace

std::optional<std::string> StreamAddress::Get(const std::string& option) const {
  const auto found = options.find(option);
  return found == options.end() ? std::nullopt : std::optional(found->second);
}

std::optional<int> StreamAddress::GetPort(const std::string& option) const {
  const auto value = Get(option);
  return value ? std::optional(ParsePort(text, *value)) : std::nullopt;
}

bool StreamAddress::GetSwitch(const std::string& option) const {
  const std::string value = Get(option).value_or("no");
  if (value == "yes" || value.empty()) return true;
  if (value == "no") return false;
  throw Error(fmt::format("{}: {} is \"{}\"; it must be yes or no", text, option, value));
}

void StreamAddress::AllowOnly(const std::vector<std::string>& names) const {
  for (const auto& [name, value] : options) {
    if (std::find(names.begin(), names.end(), name) == names.end()) {
      throw Error(fmt::format("{}: unknown option \"{}\"; {}", text, name,
                              names.empty() ? "there are none" : "use " + JoinNames(names)));
    }
  }
}

StreamAddress ParseStreamAddress(const std::string& text) {
  StreamAddress address;
  address.text = text;
  const std::size_t scheme_end = text.find("://");
  if (scheme_end == std::string::npos) {
    throw Error(fmt::format("\"{}\" is no address of a stream, such as qtm://192.168.1.10", text));
  }
  address.scheme = ToLower(text.substr(0, scheme_end));
  const std::string rest = text.substr(scheme_end + 3);
  const std::size_t question = rest.find('?');
  ParseHostAndPort(rest.substr(0, question), &address);
  std::size_t at = question;
  while (at != std::string::npos) {
    const std::size_t end = rest.find('&', at + 1);
    const std::string option = rest.substr(at + 1, end == std::string::npos ? end : end - at - 1);
    const std::size_t equals = option.find('=');
    if (!option.empty()) {
      address.options[option.substr(0, equals)] =
          equals == std::string::npos ? "" : option.substr(equals + 1);
    }
    at = end;
  }
  return address;
}

std::string InAddress(const std::string& host) {
  return host.find(':') == std::string::npos ? host : "[" + host + "]";
}

}  // namespace mmm_converter
