// SPDX-License-Identifier: MIT
#include "common/live/socket_address.h"

#include <gtest/gtest.h>

#include "common/support/error.h"

namespace mmm_converter {
namespace {

void ExpectAddress(const std::string& text, const std::string& host, int port) {
  const SocketAddress address = ParseSocketAddress(text, "127.0.0.1", 9);
  EXPECT_EQ(address.host, host) << text;
  EXPECT_EQ(address.port, port) << text;
}

TEST(SocketAddress, HostsAndPorts) {
  ExpectAddress("mvn://lab:9763", "lab", 9763);
  ExpectAddress("mvn://lab", "lab", 9);
  ExpectAddress("zmq://:5556", "127.0.0.1", 5556);
  ExpectAddress("zmq://", "127.0.0.1", 9);
  ExpectAddress("", "127.0.0.1", 9);
  ExpectAddress("[::1]:80", "::1", 80);
  ExpectAddress("ws://[::1]/", "::1", 9);
}

TEST(SocketAddress, PortsThatAreNone) {
  for (const char* text : {"a:b", "a:-1", "a:65536", "a:1.5", "a:"}) {
    EXPECT_THROW(ParseSocketAddress(text, "h", 1), Error) << text;
  }
}

}  // namespace
}  // namespace mmm_converter
