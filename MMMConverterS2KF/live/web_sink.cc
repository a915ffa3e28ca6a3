// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/live/web_sink.h"

#include <fmt/format.h>

#include <chrono>
#include <random>
#include <utility>

#include "MMMConverterS2KF/live/posture_json.h"
#include "MMMConverterS2KF/report/html.h"
#include "MMMConverterS2KF/report/page_sources.h"
#include "common/live/stream_address.h"
#include "common/live/ws/web_server.h"

namespace mmm_converter {
namespace {

constexpr int kWebSocketPort = 9002;
constexpr const char* kLoopback = "127.0.0.1";

class WebSink : public PoseSink {
 public:
  WebSink(std::string name, const WebServerOptions& options, const PostureDetails& details)
      : name_(std::move(name)), details_(details), server_(options) {}

  std::string name() const override { return name_; }
  int port() const { return server_.port(); }

  void Write(const std::shared_ptr<const LiveBody>& body, const PoseFrame& frame) override {
    if (body != body_) {
      server_.Greet(FormatBody(*body));
      body_ = body;
    }
    if (server_.clients() == 0) return;
    server_.Publish(FormatPosture(*body, frame, std::chrono::steady_clock::now(), details_));
  }

 private:
  std::string name_;
  PostureDetails details_;
  WebServer server_;
  std::shared_ptr<const LiveBody> body_;
};

std::string MakeToken() {
  std::random_device random;
  std::string token;
  for (int i = 0; i < 4; ++i) token += fmt::format("{:08x}", random());
  return token;
}

std::string MakePage(const std::string& title) {
  return FormatPage(
      {.title = title,
       .styles = LiveStyles(),
       .content = LiveContent(),
       .data = "",
       .libraries = {{SceneLibrary(), SceneLibrarySha256()}, {PlotLibrary(), PlotLibrarySha256()}},
       .script = {LiveScript(), LiveScriptSha256()},
       .policy = "connect-src 'self' ws: wss:; "});
}

}  // namespace

std::unique_ptr<PoseSink> OpenWebSocketSink(const std::string& address) {
  const StreamAddress at = ParseStreamAddress(address);
  at.AllowOnly({});
  return std::make_unique<WebSink>(
      address, WebServerOptions{at.HostOr(kLoopback), at.port.value_or(kWebSocketPort), "/", ""},
      PostureDetails{.with_segments = true});
}

LivePage OpenLivePage(const std::string& at, const std::string& title) {
  const StreamAddress address = ParseStreamAddress("http://" + at);
  const std::string host = address.HostOr(kLoopback);
  const std::string path = "/" + MakeToken() + "/";
  auto sink = std::make_unique<WebSink>(
      "--view", WebServerOptions{host, address.port.value_or(0), path, MakePage(title)},
      PostureDetails{.with_anatomy = true});
  const std::string where = fmt::format("http://{}:{}{}", InAddress(host), sink->port(), path);
  return {std::move(sink), where};
}

}  // namespace mmm_converter
