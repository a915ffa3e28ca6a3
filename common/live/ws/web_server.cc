// SPDX-License-Identifier: MIT
#include "common/live/ws/web_server.h"

#include <fmt/format.h>

#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <list>
#include <thread>
#include <utility>

#include "common/support/error.h"

namespace mmm_converter {
namespace web {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using Failure = beast::error_code;

constexpr int kMostClients = 32;
constexpr int kMostConnections = 2 * kMostClients;      // of clients, and of who asks for the page
constexpr std::chrono::milliseconds kAcceptAgain(100);  // where the system has no room
constexpr std::chrono::seconds kRequestTime(10);
constexpr std::size_t kMostRequestBytes = 16 * 1024;

using Text = std::shared_ptr<const std::string>;

// What is sent next; all on the server's thread.
struct Texts {
  Text greeting, latest;
  std::uint64_t greeting_number = 0, latest_number = 0;
};

std::string HostOf(std::string_view origin) {
  const std::size_t scheme = origin.find("://");
  return std::string(scheme == std::string_view::npos ? origin : origin.substr(scheme + 3));
}

std::string WithoutPort(std::string host) {
  const std::size_t colon = host.rfind(':');
  if (colon != std::string::npos && host.find(']', colon) == std::string::npos) host.resize(colon);
  return host;
}

// A page from elsewhere could read postures through the browser of who opens it.
bool IsLetIn(const http::request<http::string_body>& request) {
  if (request.count(http::field::origin) == 0) return true;
  const std::string origin = HostOf(std::string(request[http::field::origin]));
  const std::string name = WithoutPort(origin);
  return name == "localhost" || name == "127.0.0.1" || name == "[::1]" ||
         origin == std::string(request[http::field::host]);
}

class Client : public std::enable_shared_from_this<Client> {
 public:
  Client(tcp::socket socket, const WebServerOptions& options, const Texts& texts,
         std::atomic<int>* clients)
      : stream_(std::move(socket)), options_(options), texts_(texts), clients_(clients) {
    parser_.header_limit(kMostRequestBytes);
    parser_.body_limit(0);
  }
  ~Client() {
    if (is_counted_) --*clients_;
  }

  void Run() {
    beast::get_lowest_layer(stream_).expires_after(kRequestTime);
    http::async_read(stream_.next_layer(), buffer_, parser_,
                     [self = shared_from_this()](Failure failure, std::size_t) {
                       if (!failure) self->Answer();
                     });
  }

  void Stop() { beast::get_lowest_layer(stream_).cancel(); }
  bool is_open() const { return is_open_ && !is_closed_; }

  // Sends what is new, if the last text has been taken.
  void Send() {
    if (!is_open() || is_sending_) return;
    const bool greets = texts_.greeting && sent_greeting_ != texts_.greeting_number;
    if (!greets && (!texts_.latest || sent_ == texts_.latest_number)) return;
    sending_ = greets ? texts_.greeting : texts_.latest;
    (greets ? sent_greeting_ : sent_) = greets ? texts_.greeting_number : texts_.latest_number;
    is_sending_ = true;
    stream_.text(true);
    stream_.async_write(asio::buffer(*sending_),
                        [self = shared_from_this()](Failure failure, std::size_t) {
                          self->is_sending_ = false;
                          if (failure) self->is_closed_ = true;
                          self->Send();
                        });
  }

 private:
  void Answer() {
    const auto& request = parser_.get();
    if (websocket::is_upgrade(request)) {
      if (request.target() != options_.path) return Refuse(http::status::not_found);
      if (!IsLetIn(request)) return Refuse(http::status::forbidden);
      if (*clients_ >= kMostClients) return Refuse(http::status::service_unavailable);
      return Accept();
    }
    if (request.method() != http::verb::get) return Refuse(http::status::method_not_allowed);
    if (options_.page.empty() || request.target() != options_.path) {
      return Refuse(http::status::not_found);
    }
    Respond(http::status::ok, "text/html; charset=utf-8", options_.page);
  }

  void Accept() {
    beast::get_lowest_layer(stream_).expires_never();
    stream_.set_option(websocket::stream_base::timeout::suggested(beast::role_type::server));
    stream_.read_message_max(kMostRequestBytes);
    is_counted_ = true;
    ++*clients_;
    stream_.async_accept(parser_.get(), [self = shared_from_this()](Failure failure) {
      if (failure) return;
      self->is_open_ = true;
      self->ReadOn();
      self->Send();
    });
  }

  // Nothing that a client says counts but that it is there.
  void ReadOn() {
    stream_.async_read(heard_, [self = shared_from_this()](Failure failure, std::size_t) {
      if (failure) {
        self->is_closed_ = true;
        return;
      }
      self->heard_.clear();
      self->ReadOn();
    });
  }

  void Refuse(http::status status) {
    Respond(status, "text/plain", std::string(http::obsolete_reason(status)) + "\n");
  }

  void Respond(http::status status, const char* type, std::string body) {
    auto response = std::make_shared<http::response<http::string_body>>(status, 11);
    response->set(http::field::content_type, type);
    response->set(http::field::cache_control, "no-store");
    response->set("X-Content-Type-Options", "nosniff");
    response->set("Referrer-Policy", "no-referrer");
    response->keep_alive(false);
    response->body() = std::move(body);
    response->prepare_payload();
    http::async_write(stream_.next_layer(), *response,
                      [self = shared_from_this(), response](Failure, std::size_t) {
                        Failure ignored;
                        beast::get_lowest_layer(self->stream_)
                            .socket()
                            .shutdown(tcp::socket::shutdown_send, ignored);
                      });
  }

  websocket::stream<beast::tcp_stream> stream_;
  const WebServerOptions& options_;
  const Texts& texts_;
  std::atomic<int>* clients_;
  beast::flat_buffer buffer_{kMostRequestBytes};
  beast::flat_buffer heard_{kMostRequestBytes};
  http::request_parser<http::string_body> parser_;
  Text sending_;
  std::uint64_t sent_ = 0, sent_greeting_ = 0;
  bool is_sending_ = false, is_counted_ = false, is_open_ = false, is_closed_ = false;
};

}  // namespace web

using namespace web;  // NOLINT(google-build-using-namespace)

class WebServer::Impl {
 public:
  explicit Impl(const WebServerOptions& options)
      : options_(options), acceptor_(context_), timer_(context_) {
    Listen();
    AcceptNext();
    thread_ = std::thread([this] { context_.run(); });
  }

  ~Impl() {
    asio::post(context_, [this] {
      Failure ignored;
      acceptor_.close(ignored);
      for (const auto& one : clients_) {
        if (const auto client = one.lock()) client->Stop();
      }
      context_.stop();
    });
    thread_.join();
  }

  int port() const { return port_; }
  int clients() const { return num_clients_; }

  void Greet(std::string text) {
    asio::post(context_, [this, made = std::make_shared<const std::string>(std::move(text))] {
      texts_.greeting = made;
      ++texts_.greeting_number;
      SendAll();
    });
  }

  void Publish(std::string text) {
    asio::post(context_, [this, made = std::make_shared<const std::string>(std::move(text))] {
      texts_.latest = made;
      ++texts_.latest_number;
      SendAll();
    });
  }

 private:
  void Listen() {
    const auto check = [&](const Failure& failure) {
      if (!failure) return;
      throw Error(fmt::format("can't listen at {}:{}: {}; another program may have the port",
                              options_.host, options_.port, failure.message()));
    };
    Failure failure;
    tcp::resolver resolver(context_);
    const auto found = resolver.resolve(options_.host, std::to_string(options_.port), failure);
    check(failure);
    const tcp::endpoint endpoint = found.begin()->endpoint();
    acceptor_.open(endpoint.protocol(), failure);
    check(failure);
    acceptor_.set_option(asio::socket_base::reuse_address(true), failure);
    acceptor_.bind(endpoint, failure);
    check(failure);
    acceptor_.listen(asio::socket_base::max_listen_connections, failure);
    check(failure);
    port_ = acceptor_.local_endpoint().port();
  }

  void AcceptNext() {
    acceptor_.async_accept([this](Failure failure, tcp::socket socket) {
      if (failure == asio::error::operation_aborted) return;
      if (failure) return AcceptLater();
      Take(std::move(socket));
      AcceptNext();
    });
  }

  // A process without a handle left fails at once, again and again.
  void AcceptLater() {
    timer_.expires_after(kAcceptAgain);
    timer_.async_wait([this](Failure failure) {
      if (!failure) AcceptNext();
    });
  }

  void Take(tcp::socket socket) {
    clients_.remove_if([](const auto& one) { return one.expired(); });
    if (clients_.size() >= kMostConnections) return;  // which closes it
    Failure ignored;
    socket.set_option(tcp::no_delay(true), ignored);
    const auto client =
        std::make_shared<Client>(std::move(socket), options_, texts_, &num_clients_);
    clients_.push_back(client);
    client->Run();
  }

  void SendAll() {
    for (const auto& one : clients_) {
      if (const auto client = one.lock()) client->Send();
    }
  }

  WebServerOptions options_;
  Texts texts_;
  std::atomic<int> num_clients_ = 0;
  asio::io_context context_;
  tcp::acceptor acceptor_;
  asio::steady_timer timer_;
  std::list<std::weak_ptr<Client>> clients_;
  int port_ = 0;
  std::thread thread_;
};

WebServer::WebServer(const WebServerOptions& options) : impl_(std::make_unique<Impl>(options)) {}
WebServer::~WebServer() = default;
int WebServer::port() const { return impl_->port(); }
void WebServer::Greet(std::string text) { impl_->Greet(std::move(text)); }
void WebServer::Publish(std::string text) { impl_->Publish(std::move(text)); }
int WebServer::clients() const { return impl_->clients(); }

}  // namespace mmm_converter
