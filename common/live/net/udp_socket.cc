// SPDX-License-Identifier: MIT
#include "common/live/net/udp_socket.h"

#include <fmt/format.h>

#include <array>
#include <boost/asio.hpp>

#include "common/live/net/ports.h"
#include "common/support/error.h"

namespace mmm_converter {
namespace {

namespace asio = boost::asio;
using asio::ip::address_v4;
using asio::ip::udp;
using boost::system::error_code;

// [bytes] of the system; frames of a second wait there.
constexpr int kSocketBuffer = 4 << 20;

udp::endpoint ToEndpoint(const UdpAddress& address) {
  return {address_v4(address.ip), address.port};
}

address_v4 ToAddress(const std::string& text) {
  error_code error;
  address_v4 address = asio::ip::make_address_v4(text, error);
  if (error) throw Error(fmt::format("\"{}\" is no IPv4 address such as 192.168.1.2", text));
  return address;
}

}  // namespace

UdpAddress FindUdpAddress(const std::string& host, int port) {
  asio::io_context context;
  udp::resolver resolver(context);
  error_code error;
  const auto found = resolver.resolve(udp::v4(), host, std::to_string(ToPort(port)),
                                      udp::resolver::numeric_service, error);
  if (error || found.empty()) {
    throw Error(
        fmt::format("the host \"{}\" is not known ({}); check its name, or give its address", host,
                    error.message()));
  }
  const udp::endpoint endpoint = found.begin()->endpoint();
  return {endpoint.address().to_v4().to_uint(), endpoint.port()};
}

std::string FormatIp(const UdpAddress& address) { return address_v4(address.ip).to_string(); }

struct UdpSocket::State {
  asio::io_context context;
  udp::socket socket{context};
  std::array<char, kReceivedAtOnce> buffer{};
};

UdpSocket::UdpSocket(const std::string& address, int port, bool shared)
    : state_(std::make_unique<State>()) {
  const address_v4 ip = address.empty() ? address_v4::any() : ToAddress(address);
  udp::socket& socket = state_->socket;
  error_code error, ignored;
  socket.open(udp::v4(), error);
  if (!error && shared) socket.set_option(asio::socket_base::reuse_address(true), error);
  if (!error) socket.bind({ip, ToPort(port)}, error);
  if (!error) socket.non_blocking(true, error);
  if (error) FailToServe(ip.to_string(), port, error.message());
  socket.set_option(asio::socket_base::receive_buffer_size(kSocketBuffer), ignored);
}

UdpSocket::~UdpSocket() = default;
UdpSocket::UdpSocket(UdpSocket&&) noexcept = default;
UdpSocket& UdpSocket::operator=(UdpSocket&&) noexcept = default;

int UdpSocket::port() const { return state_->socket.local_endpoint().port(); }

void UdpSocket::Join(const std::string& group, const std::string& interface_address) {
  const address_v4 ip = ToAddress(group);
  if (!ip.is_multicast()) {
    throw Error(
        fmt::format("{} is no multicast group; groups are 224.0.0.0 to 239.255.255.255", group));
  }
  error_code error;
  state_->socket.set_option(asio::ip::multicast::join_group(ip, ToAddress(interface_address)),
                            error);
#ifdef IP_MULTICAST_ALL
  // Not what other programs of this computer have joined.
  const int all = 0;
  ::setsockopt(state_->socket.native_handle(), IPPROTO_IP, IP_MULTICAST_ALL, &all, sizeof all);
#endif
  if (error) {
    throw Error(fmt::format(
        "the multicast group {} can't be joined through {}: {}; give the address of the network "
        "interface of this computer towards the cameras, or let the server stream unicast",
        group, interface_address, error.message()));
  }
}

void UdpSocket::SendThrough(const std::string& interface_address) {
  error_code error;
  state_->socket.set_option(asio::ip::multicast::outbound_interface(ToAddress(interface_address)),
                            error);
  if (!error) state_->socket.set_option(asio::ip::multicast::enable_loopback(true), error);
  if (error) {
    throw Error(
        fmt::format("multicast can't be sent through {}: {}", interface_address, error.message()));
  }
}

void UdpSocket::AllowBroadcast() {
  error_code ignored;
  state_->socket.set_option(asio::socket_base::broadcast(true), ignored);
}

bool UdpSocket::Send(std::string_view datagram, const UdpAddress& to) {
  error_code error;
  state_->socket.send_to(asio::buffer(datagram), ToEndpoint(to), 0, error);
  return !error;
}

std::optional<std::string_view> UdpSocket::Receive(UdpAddress* from) {
  udp::endpoint sender;
  // What was refused of an earlier datagram is reported here: there may be more behind it.
  for (int i = 0; i < 8; ++i) {
    error_code error;
    const std::size_t count =
        state_->socket.receive_from(asio::buffer(state_->buffer), sender, 0, error);
    if (error == asio::error::connection_refused) continue;
    if (error) return std::nullopt;
    *from = {sender.address().to_v4().to_uint(), sender.port()};
    return std::string_view(state_->buffer.data(), count);
  }
  return std::nullopt;
}

WaitFor UdpSocket::Waiting() const { return {state_->socket.native_handle(), false}; }

std::string LocalAddressTowards(const UdpAddress& other) {
  asio::io_context context;
  udp::socket socket(context);
  error_code error;
  socket.open(udp::v4(), error);
  if (!error) socket.connect(ToEndpoint(other), error);
  const udp::endpoint local = error ? udp::endpoint() : socket.local_endpoint(error);
  if (error) {
    throw Error(fmt::format("there is no way to {}: {}; check the network", FormatIp(other),
                            error.message()));
  }
  return local.address().to_string();
}

}  // namespace mmm_converter
