// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/live/web_sink.h"

#include <fmt/format.h>

#include <chrono>
#include <random>
#include <utility>
#include <vector>

#include "MMMConverterS2KF/live/posture_json.h"
#include "MMMConverterS2KF/report/html.h"
#include "MMMConverterS2KF/report/page_sources.h"
#include "common/live/stream_address.h"
#include "common/live/ws/web_server.h"

namespace mmm_converter {
namespace {

constexpr int kWebSocketPort = 9002;
constexpr const char* kLoopback = "127.0.0.1";

// A text of the first body with those of the others.
std::string WithObjects(std::string first, const std::vector<std::string>& objects) {
  if (objects.empty()) return first;
  while (first.back() != '}') first.pop_back();
  first.pop_back();
  return first + fmt::format(",\"objects\":[{}]}}", fmt::join(objects, ","));
}

class WebSink : public PoseSink {
 public:
  WebSink(std::string name, const WebServerOptions& options, const PostureDetails& details)
      : name_(std::move(name)), details_(details), server_(options) {}

  std::string name() const override { return name_; }
  int port() const { return server_.port(); }

  void Write(const std::shared_ptr<const LiveBody>& body, const PoseFrame& frame) override {
    bodies_.resize(static_cast<std::size_t>(body->count));
    auto& known = bodies_[static_cast<std::size_t>(body->index)];
    if (body != known) {
      known = body;
      Greet();
    }
    if (server_.clients() == 0) {
      first_.clear();
      return;
    }
    std::string text = FormatPosture(*body, frame, std::chrono::steady_clock::now(), details_);
    if (body->index == 0) {
      first_ = std::move(text);
      objects_.clear();
    } else if (!first_.empty()) {
      objects_.push_back(std::move(text));
    }
    // Clients get a frame whole.
    if (body->index + 1 == body->count && !first_.empty()) {
      server_.Publish(WithObjects(std::exchange(first_, {}), objects_));
    }
  }

 private:
  void Greet() {
    if (!bodies_.front()) return;
    std::vector<std::string> objects;
    for (std::size_t i = 1; i < bodies_.size(); ++i) {
      if (bodies_[i]) objects.push_back(FormatBody(*bodies_[i]));
    }
    server_.Greet(WithObjects(FormatBody(*bodies_.front()), objects));
  }

  std::string name_;
  PostureDetails details_;
  WebServer server_;
  std::vector<std::shared_ptr<const LiveBody>> bodies_;  // null: not known yet
  std::string first_;                                    // posture of the frame that comes in
  std::vector<std::string> objects_;
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
