// SPDX-License-Identifier: MIT
#include "common/live/ws/web_server.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>

#include <list>
#include <vector>

#include "common/support/error.h"

namespace mmm_converter {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using asio::ip::tcp;
using ::testing::HasSubstr;

tcp::socket Connect(asio::io_context* context, const WebServer& server) {
  tcp::socket socket(*context);
  socket.connect({asio::ip::make_address("127.0.0.1"), static_cast<unsigned short>(server.port())});
  return socket;
}

class WebClient {
 public:
  // target: "/secret/". origin: of a browser; empty: none.
  WebClient(const WebServer& server, const std::string& target, const std::string& origin = "")
      : stream_(Connect(&context_, server)) {
    stream_.set_option(
        beast::websocket::stream_base::decorator([origin](beast::websocket::request_type& request) {
          if (!origin.empty()) request.set(http::field::origin, origin);
        }));
    stream_.handshake("127.0.0.1", target, failure_);
  }
  bool is_in() const { return !failure_; }
  std::string Read() {
    beast::flat_buffer buffer;
    stream_.read(buffer);
    return beast::buffers_to_string(buffer.data());
  }
  // Whether the server ends the connection for such a text, or while it is being sent.
  bool IsEndedBy(const std::string& text) {
    beast::error_code failure;
    stream_.write(asio::buffer(text), failure);
    beast::flat_buffer buffer;
    if (!failure) stream_.read(buffer, failure);
    return bool(failure);
  }

 private:
  asio::io_context context_;
  beast::websocket::stream<tcp::socket> stream_;
  beast::error_code failure_;
};

// Status and body of a GET, or of any text sent.
std::pair<int, std::string> Ask(const WebServer& server, const std::string& request) {
  asio::io_context context;
  tcp::socket socket = Connect(&context, server);
  beast::error_code closed;  // by a server that has read enough
  asio::write(socket, asio::buffer(request), closed);
  beast::flat_buffer buffer;
  http::response<http::string_body> response;
  beast::error_code failure;
  http::read(socket, buffer, response, failure);
  return failure ? std::pair(0, std::string())
                 : std::pair(int(response.result_int()), response.body());
}

std::pair<int, std::string> Get(const WebServer& server, const std::string& target) {
  return Ask(server, "GET " + target + " HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n");
}

WebServerOptions Secret() { return {"127.0.0.1", 0, "/secret/", "<p>the page</p>"}; }

TEST(WebServer, OnePageAndNothingElse) {
  const WebServer server(Secret());
  EXPECT_EQ(Get(server, "/secret/"), std::pair(200, std::string("<p>the page</p>")));
  for (const char* target : {"/", "/secret", "/secret/x", "/secret/../secret/", "/etc/passwd",
                             "//secret/", "/secret/?x"}) {
    EXPECT_EQ(Get(server, target).first, 404) << target;
  }
  EXPECT_EQ(Ask(server, "POST /secret/ HTTP/1.1\r\nHost: a\r\n\r\n").first, 405);
}

TEST(WebServer, WhatIsNoRequestIsNotAnswered) {
  const WebServer server(Secret());
  EXPECT_EQ(Ask(server, "\x16\x03\x01 hello\r\n\r\n").first, 0);
  EXPECT_EQ(Ask(server, "GET / HTTP/1.1\r\nX: " + std::string(100000, 'x') + "\r\n\r\n").first, 0);
  EXPECT_EQ(Get(server, "/secret/").first, 200);
}

TEST(WebServer, ClientsAreGreetedAndGetWhatIsPublished) {
  WebServer server(Secret());
  server.Greet("hello");
  WebClient early(server, "/secret/");
  EXPECT_EQ(early.Read(), "hello");
  EXPECT_EQ(server.clients(), 1);
  server.Publish("1");
  EXPECT_EQ(early.Read(), "1");
  WebClient late(server, "/secret/");
  EXPECT_EQ(late.Read(), "hello");
  EXPECT_EQ(late.Read(), "1");
  server.Greet("another");
  server.Publish("2");
  for (WebClient* client : {&early, &late}) {
    EXPECT_EQ(client->Read(), "another");
    EXPECT_EQ(client->Read(), "2");
  }
}

TEST(WebServer, AClientThatStallsMissesTextsAndTheOthersGetThem) {
  WebServer server(Secret());
  WebClient stalled(server, "/secret/");
  WebClient other(server, "/secret/");
  const std::string padding(1 << 20, 'x');
  for (int k = 0; k < 40; ++k) {
    server.Publish(std::to_string(k) + padding);
    EXPECT_EQ(other.Read(), std::to_string(k) + padding);
  }
  // The stalled one gets what was on its way, and the last.
  int texts = 1;
  while (stalled.Read() != "39" + padding) ++texts;
  EXPECT_LT(texts, 40);
}

TEST(WebServer, ClientsAndConnectionsAreLimited) {
  WebServer server(Secret());
  std::list<WebClient> clients;
  for (int i = 0; i < 32; ++i) EXPECT_TRUE(clients.emplace_back(server, "/secret/").is_in()) << i;
  EXPECT_FALSE(WebClient(server, "/secret/").is_in());
  EXPECT_EQ(Get(server, "/secret/").first, 200);
  asio::io_context context;
  std::vector<tcp::socket> silent;
  for (int i = 0; i < 40; ++i) silent.push_back(Connect(&context, server));
  // Those for which there is no room are closed at once, not only when they have said nothing for
  // long.
  char byte = 0;
  beast::error_code failure;
  silent.back().read_some(asio::buffer(&byte, 1), failure);
  EXPECT_TRUE(failure) << failure.message();
  EXPECT_EQ(server.clients(), 32);
  server.Publish("text");
  EXPECT_EQ(clients.back().Read(), "text");
}

TEST(WebServer, WhoSaysTooMuchAtOnceIsOut) {
  WebServer server(Secret());
  WebClient talkative(server, "/secret/"), other(server, "/secret/");
  EXPECT_TRUE(talkative.IsEndedBy(std::string(std::size_t{16} << 20, 'x')));
  server.Publish("text");
  EXPECT_EQ(other.Read(), "text");
}

TEST(WebServer, OnlyPagesOfThisMachineAreLetIn) {
  const WebServer server(Secret());
  EXPECT_TRUE(WebClient(server, "/secret/").is_in());
  EXPECT_TRUE(WebClient(server, "/secret/", "http://localhost:8000").is_in());
  EXPECT_TRUE(WebClient(server, "/secret/", "http://127.0.0.1").is_in());
  EXPECT_FALSE(WebClient(server, "/secret/", "https://example.org").is_in());
  EXPECT_FALSE(WebClient(server, "/secret/", "https://localhost.example.org").is_in());
  EXPECT_FALSE(WebClient(server, "/secret/", "null").is_in());
  EXPECT_FALSE(WebClient(server, "/", "").is_in());
}

TEST(WebServer, APortThatSomebodyHas) {
  const WebServer server(Secret());
  WebServerOptions options = Secret();
  options.port = server.port();
  try {
    const WebServer second(options);
    FAIL() << "it listens twice";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("another program may have the port"));
  }
}

}  // namespace
}  // namespace mmm_converter
