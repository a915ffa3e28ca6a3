// SPDX-License-Identifier: MIT
#include "common/live/net/tcp_connection.h"

#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>

#include <array>
#include <boost/asio.hpp>
#include <cerrno>
#include <utility>
#include <vector>

#include "common/live/net/ports.h"

namespace mmm_converter {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

bool IsForLater(const error_code& error) {
  return error == asio::error::would_block || error == asio::error::try_again ||
         error == asio::error::interrupted;
}

}  // namespace

struct TcpConnection::State {
  asio::io_context context;
  tcp::socket socket{context};
  std::vector<tcp::endpoint> untried;  // the last first
  bool is_connecting = false;
  std::string failure;
  std::array<char, kReceivedAtOnce> buffer{};

  void Close(const std::string& reason) {
    error_code ignored;
    socket.close(ignored);
    is_connecting = false;
    failure = reason;
  }

  void ConnectToNext() {
    if (untried.empty()) return Close(failure.empty() ? "the host has no address" : failure);
    const tcp::endpoint endpoint = untried.back();
    untried.pop_back();
    error_code error;
    socket.close(error);
    socket.open(endpoint.protocol(), error);
    if (!error) socket.non_blocking(true, error);
    is_connecting = true;
    // The call itself, since asio's would wait for a socket that it does not know as non-blocking.
    if (!error && ::connect(socket.native_handle(), endpoint.data(),
                            static_cast<socklen_t>(endpoint.size())) != 0) {
      error.assign(errno, boost::system::system_category());
    }
    if (error == asio::error::in_progress || IsForLater(error)) return;
    Connected(error);
  }

  void Connected(error_code error) {
    if (error) {
      failure = error.message();
      return ConnectToNext();
    }
    is_connecting = false;
    failure.clear();
    SetOptions();
  }

  /// Small packets leave at once; a peer that is gone without a word is noticed in half a minute.
  void SetOptions() {
    error_code ignored;
    socket.set_option(tcp::no_delay(true), ignored);
    socket.set_option(asio::socket_base::keep_alive(true), ignored);
#ifdef TCP_KEEPIDLE
    for (const auto& [option, value] :
         {std::pair(TCP_KEEPIDLE, 15), std::pair(TCP_KEEPINTVL, 5), std::pair(TCP_KEEPCNT, 3)}) {
      ::setsockopt(socket.native_handle(), IPPROTO_TCP, option, &value, sizeof value);
    }
#endif
  }
};

TcpConnection::TcpConnection() : state_(std::make_unique<State>()) {}
TcpConnection::~TcpConnection() = default;
TcpConnection::TcpConnection(TcpConnection&&) noexcept = default;
TcpConnection& TcpConnection::operator=(TcpConnection&&) noexcept = default;

TcpConnection TcpConnection::To(const std::string& host, int port) {
  TcpConnection connection;
  State& state = *connection.state_;
  error_code error;
  tcp::resolver resolver(state.context);
  const auto found =
      resolver.resolve(host, std::to_string(ToPort(port)), tcp::resolver::numeric_service, error);
  if (error) {
    state.failure = error.message();
    return connection;
  }
  for (const auto& entry : found) state.untried.insert(state.untried.begin(), entry.endpoint());
  state.ConnectToNext();
  return connection;
}

bool TcpConnection::is_open() const { return state_->socket.is_open(); }
bool TcpConnection::is_connecting() const { return state_->is_connecting; }

void TcpConnection::Proceed() {
  if (!is_open() || !is_connecting()) return;
  pollfd polled{state_->socket.native_handle(), POLLOUT, 0};
  if (::poll(&polled, 1, 0) <= 0) return;
  int failure = 0;
  socklen_t size = sizeof failure;
  ::getsockopt(state_->socket.native_handle(), SOL_SOCKET, SO_ERROR, &failure, &size);
  state_->Connected({failure, boost::system::system_category()});
}

bool TcpConnection::Receive(std::string* bytes) {
  if (!is_open() || is_connecting()) return false;
  error_code error;
  const std::size_t count = state_->socket.read_some(asio::buffer(state_->buffer), error);
  bytes->append(state_->buffer.data(), count);
  if (error == asio::error::eof) {
    Close("the other side has closed the connection");
  } else if (error && !IsForLater(error)) {
    Close(error.message());
  }
  return count > 0;
}

std::size_t TcpConnection::Send(std::string_view bytes) {
  if (!is_open() || is_connecting() || bytes.empty()) return 0;
  error_code error;
  const std::size_t count = state_->socket.write_some(asio::buffer(bytes), error);
  if (error && !IsForLater(error)) Close(error.message());
  return count;
}

void TcpConnection::Close(const std::string& failure) { state_->Close(failure); }

const std::string& TcpConnection::failure() const { return state_->failure; }

std::string TcpConnection::peer() const {
  error_code error;
  const tcp::endpoint endpoint = state_->socket.remote_endpoint(error);
  return error ? "" : endpoint.address().to_string();
}

WaitFor TcpConnection::Waiting(bool has_bytes_to_send) const {
  if (!is_open()) return {};
  return {state_->socket.native_handle(), has_bytes_to_send || is_connecting()};
}

struct TcpListener::State {
  asio::io_context context;
  tcp::acceptor acceptor{context};
};

TcpListener::TcpListener(const std::string& address, int port) : state_(std::make_unique<State>()) {
  error_code error;
  const auto ip = asio::ip::make_address(address, error);
  if (!error) {
    const tcp::endpoint endpoint(ip, ToPort(port));
    tcp::acceptor& acceptor = state_->acceptor;
    acceptor.open(endpoint.protocol(), error);
    if (!error) acceptor.set_option(asio::socket_base::reuse_address(true), error);
    if (!error) acceptor.bind(endpoint, error);
    if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
    if (!error) acceptor.non_blocking(true, error);
  }
  if (error) FailToServe(address, port, error.message());
}

TcpListener::~TcpListener() = default;

int TcpListener::port() const { return state_->acceptor.local_endpoint().port(); }

bool TcpListener::Accept(TcpConnection* connection) {
  TcpConnection accepted;
  error_code error;
  state_->acceptor.accept(accepted.state_->socket, error);
  if (error) return false;
  accepted.state_->socket.non_blocking(true, error);
  accepted.state_->SetOptions();
  *connection = std::move(accepted);
  return true;
}

WaitFor TcpListener::Waiting() const { return {state_->acceptor.native_handle(), false}; }

}  // namespace mmm_converter
