// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "common/live/net/wait.h"

namespace mmm_converter {

/// A TCP connection that never waits. What went wrong closes it and is failure().
class TcpConnection {
 public:
  TcpConnection();  ///< closed
  ~TcpConnection();
  TcpConnection(TcpConnection&&) noexcept;
  TcpConnection& operator=(TcpConnection&&) noexcept;

  /// Begins to connect; of several addresses of the host one after the other is tried. Looking up
  /// the name of a host may take its time.
  static TcpConnection To(const std::string& host, int port);

  bool is_open() const;        ///< connected, or on the way
  bool is_connecting() const;  ///< as of the last Proceed
  /// Goes on with connecting; for when waiting has ended.
  void Proceed();

  /// Appends the bytes that are there, at most some 64 kB. false: there are none.
  bool Receive(std::string* bytes);
  /// As many of the bytes as the system takes now.
  std::size_t Send(std::string_view bytes);
  void Close(const std::string& failure = "");

  const std::string& failure() const;  ///< a reason in words, of a closed connection
  std::string peer() const;            ///< the other's IP address; empty: not connected
  WaitFor Waiting(bool has_bytes_to_send = false) const;

 private:
  friend class TcpListener;
  struct State;
  std::unique_ptr<State> state_;
};

/// Takes connections.
class TcpListener {
 public:
  /// port 0: any that is free.
  /// @throws Error where the port is taken, or the address is none of this computer.
  TcpListener(const std::string& address, int port);
  ~TcpListener();
  TcpListener(const TcpListener&) = delete;
  TcpListener& operator=(const TcpListener&) = delete;

  int port() const;
  /// false: nobody connects.
  bool Accept(TcpConnection* connection);
  WaitFor Waiting() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace mmm_converter
