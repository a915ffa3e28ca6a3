// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "common/live/net/tcp_connection.h"
#include "common/live/qtm/qtm_packet.h"

namespace mmm_converter {

/// Packets over a TCP connection, of either side.
class QtmConnection {
 public:
  /// Closed. most_bytes: of a packet that is received.
  explicit QtmConnection(std::size_t most_bytes = kMostQtmBytes) : most_bytes_(most_bytes) {}

  void Use(TcpConnection connection);
  void Close(const std::string& failure = "") { tcp_.Close(failure); }
  const TcpConnection& tcp() const { return tcp_; }
  WaitFor Waiting() const { return tcp_.Waiting(!out_.empty()); }

  /// To be sent by Flush; append to it.
  std::string* out() { return &out_; }
  std::size_t bytes_to_send() const { return out_.size(); }
  void SendCommand(std::string_view text);
  void Flush();

  /// Connects on, sends, and receives bytes that are there. false: there were none.
  bool Receive();
  /// The next packet of what was received, whole with its header, valid until the next call. What
  /// can't be a packet closes the connection.
  bool Take(std::string_view* packet);

 private:
  std::size_t most_bytes_;
  TcpConnection tcp_;
  std::string in_, out_;
  std::size_t taken_ = 0;  // of in_
};

}  // namespace mmm_converter
