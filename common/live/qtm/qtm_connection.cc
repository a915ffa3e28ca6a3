// SPDX-License-Identifier: MIT
#include "common/live/qtm/qtm_connection.h"

#include <fmt/format.h>

#include <utility>

#include "common/support/error.h"

namespace mmm_converter {

void QtmConnection::Use(TcpConnection connection) {
  tcp_ = std::move(connection);
  in_.clear();
  out_.clear();
  taken_ = 0;
}

void QtmConnection::SendCommand(std::string_view text) {
  AppendQtmText(QtmPacketType::kCommand, text, &out_);
  Flush();
}

void QtmConnection::Flush() {
  while (!out_.empty()) {
    const std::size_t sent = tcp_.Send(out_);
    if (sent == 0) return;
    out_.erase(0, sent);
  }
}

bool QtmConnection::Receive() {
  tcp_.Proceed();
  Flush();
  in_.erase(0, taken_);
  taken_ = 0;
  return tcp_.Receive(&in_);
}

bool QtmConnection::Take(std::string_view* packet) {
  const std::string_view rest = std::string_view(in_).substr(taken_);
  std::size_t size = 0;
  try {
    size = QtmPacketSize(rest);
    if (size > most_bytes_) throw Error(fmt::format("a packet of {} bytes", size));
  } catch (const Error& error) {
    taken_ = in_.size();
    Close(fmt::format("what comes is no packet of QTM ({})", error.what()));
    return false;
  }
  if (size == 0 || rest.size() < size) return false;
  *packet = rest.substr(0, size);
  taken_ += size;
  return true;
}

}  // namespace mmm_converter
