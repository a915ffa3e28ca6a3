// SPDX-License-Identifier: MIT
#include "common/live/stream_address.h"

#include <gtest/gtest.h>

#include "common/support/error.h"

namespace mmm_converter {
namespace {

void ExpectAddress(const std::string& text, const std::string& host, int port) {
  const StreamAddress address = ParseStreamAddress(text);
  EXPECT_EQ(address.HostOr("127.0.0.1"), host) << text;
  EXPECT_EQ(address.port.value_or(9), port) << text;
}

TEST(StreamAddress, HostsAndPorts) {
  ExpectAddress("mvn://lab:9763", "lab", 9763);
  ExpectAddress("mvn://lab", "lab", 9);
  ExpectAddress("zmq://:5556", "127.0.0.1", 5556);
  ExpectAddress("zmq://", "127.0.0.1", 9);
  ExpectAddress("ws://[::1]:80/", "::1", 80);
  ExpectAddress("ws://[::1]", "::1", 9);
}

TEST(StreamAddress, Options) {
  const StreamAddress address = ParseStreamAddress("natnet://lab?up=z&multicast");
  EXPECT_EQ(address.host, "lab");
  EXPECT_EQ(address.Get("up"), "z");
  EXPECT_EQ(address.Get("multicast"), "");
  EXPECT_EQ(address.Get("local"), std::nullopt);
  EXPECT_THROW(address.AllowOnly({"up"}), Error);
  EXPECT_THROW(address.AllowOnly({}), Error);
  EXPECT_NO_THROW(address.AllowOnly({"up", "multicast"}));
}

TEST(StreamAddress, WhatIsNone) {
  for (const char* text :
       {"lab", "a://b:c", "a://b:-1", "a://b:65536", "a://b:1.5", "a://b:", "a://[::1", ""}) {
    EXPECT_THROW(ParseStreamAddress(text), Error) << text;
  }
}

}  // namespace
}  // namespace mmm_converter
