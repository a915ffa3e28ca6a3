// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

namespace mmm_converter {

struct WebServerOptions {
  std::string host = "127.0.0.1";
  int port = 0;            ///< 0: a free one
  std::string path = "/";  ///< all else is not found; begins and ends with /
  std::string page;        ///< HTML that is served at the path; empty: none
};

/// Serves one page and sends texts to any number of WebSocket clients at the same path, on a thread
/// of its own. A client that does not take what it is sent misses texts, and costs no more than the
/// last of them. At most 32 clients; others are refused. Nor are there more than 64 connections.
/// Browsers are let in from pages of this machine and of the server itself only.
class WebServer {
 public:
  /// @throws Error where it can't listen there.
  explicit WebServer(const WebServerOptions& options);
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  int port() const;

  /// What every client gets before anything else, and again whenever it is new.
  void Greet(std::string text);
  /// To every client that has taken what it was sent before; the others get the next one.
  void Publish(std::string text);
  int clients() const;  ///< that are connected now

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace mmm_converter
