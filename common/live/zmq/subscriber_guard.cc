// SPDX-License-Identifier: MIT
#include "common/live/zmq/subscriber_guard.h"

#include <fmt/format.h>
#include <linux/tcp.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <zmq.h>

#include <cerrno>
#include <cstdint>
#include <cstring>

#include "common/support/error.h"

namespace mmm_converter {
namespace {

constexpr std::chrono::milliseconds kLookEvery(10);

// What was received through a connection [bytes].
double Heard(int handle) {
  tcp_info info{};
  socklen_t size = sizeof info;
  if (::getsockopt(handle, IPPROTO_TCP, TCP_INFO, &info, &size) != 0) return 0;
  return static_cast<double>(info.tcpi_bytes_received);
}

}  // namespace

SubscriberGuard::SubscriberGuard(void* context, void* publisher, int port)
    : publisher_(publisher), events_(zmq_socket(context, ZMQ_PAIR)), port_(port) {
  const std::string address = fmt::format("inproc://connections-at-{}", port);
  constexpr int kEvents = ZMQ_EVENT_ACCEPTED | ZMQ_EVENT_MONITOR_STOPPED;
  if (events_ == nullptr || zmq_socket_monitor(publisher, address.c_str(), kEvents) != 0 ||
      zmq_connect(events_, address.c_str()) != 0) {
    const std::string reason = zmq_strerror(zmq_errno());
    if (events_ != nullptr) zmq_close(events_);
    throw Error(fmt::format("connections to port {} can't be watched: {}", port, reason));
  }
  thread_ = std::thread([this] { Watch(); });
}

SubscriberGuard::~SubscriberGuard() {
  zmq_socket_monitor(publisher_, nullptr, 0);  // its last event ends the thread
  thread_.join();
  zmq_close(events_);
}

void SubscriberGuard::Watch() {
  while (true) {
    zmq_pollitem_t item{events_, 0, ZMQ_POLLIN, 0};
    const long wait = since_.empty() ? -1 : static_cast<long>(kLookEvery.count());
    if (zmq_poll(&item, 1, wait) > 0 && !TakeEvent()) return;
    EndTalkative();
  }
}

bool SubscriberGuard::TakeEvent() {
  // u16 event, u32 value; a second part has the address.
  unsigned char bytes[6] = {};
  if (zmq_recv(events_, bytes, sizeof bytes, 0) < 0) return zmq_errno() == EINTR;
  char address[256];
  zmq_recv(events_, address, sizeof address, 0);
  std::uint16_t event = 0;
  std::int32_t value = 0;
  std::memcpy(&event, bytes, sizeof event);
  std::memcpy(&value, bytes + sizeof event, sizeof value);
  if (event == ZMQ_EVENT_MONITOR_STOPPED) return false;
  if (event == ZMQ_EVENT_ACCEPTED) TakeConnection(value);
  return true;
}

void SubscriberGuard::TakeConnection(int handle) {
  std::erase_if(since_, [this](const auto& one) { return !IsConnection(one.first); });
  if (!IsConnection(handle)) return;
  if (since_.count(handle) == 0 && since_.size() >= kMostSubscribers) {
    ::shutdown(handle, SHUT_RDWR);  // ZeroMQ closes it
    return;
  }
  since_[handle] = std::chrono::steady_clock::now();
}

void SubscriberGuard::EndTalkative() {
  const Time now = std::chrono::steady_clock::now();
  std::erase_if(since_, [&](const auto& one) {
    const auto& [handle, since] = one;
    if (!IsConnection(handle)) return true;
    const std::chrono::duration<double> age = now - since;
    if (Heard(handle) <= kMostHeard + kMoreInASecond * age.count()) return false;
    ::shutdown(handle, SHUT_RDWR);
    return true;
  });
}

// The handle of a connection that was closed may be something else's now.
bool SubscriberGuard::IsConnection(int handle) const {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  if (::getsockname(handle, reinterpret_cast<sockaddr*>(&address), &size) != 0) return false;
  in_port_t port = 0;
  if (address.ss_family == AF_INET) {
    port = reinterpret_cast<const sockaddr_in*>(&address)->sin_port;
  } else if (address.ss_family == AF_INET6) {
    port = reinterpret_cast<const sockaddr_in6*>(&address)->sin6_port;
  }
  return ntohs(port) == port_;
}

}  // namespace mmm_converter
