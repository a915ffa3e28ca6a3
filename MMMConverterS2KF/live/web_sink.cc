// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/live/web_sink.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "MMMConverterS2KF/report/html.h"
#include "MMMConverterS2KF/report/model_json.h"
#include "MMMConverterS2KF/report/page_sources.h"
#include "common/live/marker_states.h"
#include "common/live/pose_frame.h"
#include "common/live/stream_address.h"
#include "common/live/ws/web_server.h"
#include "common/model/forward_kinematics.h"
#include "common/motion/anatomical_angles.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

/// What postures are written with beyond themselves.
struct PostureDetails {
  bool with_segments = false;  ///< the pose of every segment
  bool with_anatomy = false;   ///< angles by their anatomical names [rad], of a person
};

// Numbers as JSON has them, without a tree in between: this is made for every frame.
class JsonText {
 public:
  void Key(const char* name) {
    if (text_.back() != '{') text_ += ',';
    fmt::format_to(std::back_inserter(text_), "\"{}\":", name);
  }
  void Add(double value) {
    if (text_.back() != '[' && text_.back() != ':') text_ += ',';
    if (std::isfinite(value)) {
      fmt::format_to(std::back_inserter(text_), "{:.9g}", value);
    } else {
      text_ += "null";
    }
  }
  template <typename Vector>
  void AddAll(const Vector& values) {
    for (Eigen::Index i = 0; i < values.size(); ++i) Add(values[i]);
  }
  void Raw(std::string_view text) { text_ += text; }
  void Open() {
    if (text_.back() == ']') text_ += ',';
    text_ += '[';
  }
  void Close() { text_ += ']'; }
  std::string Take() { return std::move(text_) + "}"; }

 private:
  std::string text_ = "{";
};

void AddPosture(const LiveBody& body, const FrameEstimate& estimate, JsonText* json) {
  const Posture& posture = estimate.posture;
  json->Key("root");
  json->Open();
  json->AddAll(posture.position);
  json->AddAll(posture.orientation.coeffs());
  json->Close();
  json->Key("angles");
  json->Open();
  for (const int joint : body.setup.joints) json->Add(posture.joint_angles[joint]);
  json->Close();
  json->Key("sd");
  json->Open();
  if (estimate.standard_deviations.size() > 0) {
    for (const int joint : body.setup.joints) json->Add(estimate.standard_deviations[6 + joint]);
  }
  json->Close();
}

void AddSegments(const KinematicModel& model, const Posture& posture, JsonText* json) {
  json->Key("segments");
  json->Open();
  for (const Eigen::Isometry3d& X_WS : SegmentPoses(model, posture)) {
    json->Open();
    json->AddAll(X_WS.translation());
    json->AddAll(Eigen::Quaterniond(X_WS.linear()).coeffs());
    json->Close();
  }
  json->Close();
}

void AddMarkers(const LiveBody& body, const PoseFrame& frame, JsonText* json) {
  json->Key("markers");
  json->Open();
  for (Eigen::Index i = 0; i < frame.points.cols(); ++i) {
    json->Open();
    json->AddAll(frame.points.col(i));
    json->Close();
  }
  json->Close();
  const MarkerStates states = StatesOfMarkers(body, frame);
  json->Key("states");
  json->Open();
  for (const MarkerState state : states.states) json->Add(static_cast<double>(state));
  json->Close();
  json->Key("distances");
  json->Open();
  for (const double distance : states.distances) json->Add(distance);
  json->Close();
}

AnatomicalAngles AnglesOf(const LiveBody& body, const Posture& posture) {
  PoseTrajectory one;
  one.rate = 1;
  one.joint_names.reserve(body.setup.joints.size());
  Posture tracked = posture;
  tracked.joint_angles.resize(static_cast<Eigen::Index>(body.setup.joints.size()));
  for (std::size_t i = 0; i < body.setup.joints.size(); ++i) {
    const int joint = body.setup.joints[i];
    one.joint_names.push_back(body.setup.model->joint(joint).name);
    tracked.joint_angles[static_cast<Eigen::Index>(i)] = posture.joint_angles[joint];
  }
  one.postures = {tracked};
  return ComputeAnatomicalAngles(*body.setup.model, one);
}

// What the angles of a posture are called.
Json AnatomyNames(const LiveBody& body) {
  Json names = Json::array();
  if (!HasAnatomy(*body.setup.model)) return names;
  const AnatomicalAngles angles = AnglesOf(body, ZeroPosture(*body.setup.model));
  for (const AnatomicalAngle& one : angles.angles) {
    names.push_back({{"joint", one.joint}, {"side", one.side}, {"motion", one.motion}});
  }
  return names;
}

/// What a WebSocket client gets of a body before its postures (../README.md).
std::string FormatBody(const LiveBody& body) {
  const KinematicModel& model = *body.setup.model;
  std::vector<int> markers(body.labels.size(), -1);
  for (const MarkerAssignment& one : body.setup.assignments()) {
    markers[static_cast<std::size_t>(one.label)] = one.marker;
  }
  const Json json = {{"body", body.name},
                     {"calibrated", body.is_calibrated},
                     {"rate", body.rate > 0 ? Json(body.rate) : Json(nullptr)},
                     {"labels", body.labels},
                     {"markers", markers},
                     {"joints", body.setup.joints},
                     {"anatomy", AnatomyNames(body)},
                     {"model", ToJson(model)}};
  return FormatJsonLine(json);
}

/// One posture.
std::string FormatPosture(const LiveBody& body, const PoseFrame& frame, SteadyTime now,
                          const PostureDetails& details) {
  JsonText json;
  const std::chrono::duration<double> delay = now - frame.received;
  json.Raw(
      fmt::format("\"frame\":{},\"time\":{},\"tracking\":{},\"stage\":\"{}\",\"progress\":{:.3f},"
                  "\"delay_ms\":{:.4f},\"dropped\":{},\"lost\":{}",
                  frame.number, frame.time, frame.is_tracking, frame.stage, frame.progress,
                  kMilliseconds * delay.count(), frame.dropped, frame.counts.lost));
  if (body.index > 0)
    json.Raw(fmt::format(",\"body\":{}",
                         Json(body.name).dump(-1, ' ', false, Json::error_handler_t::replace)));
  AddMarkers(body, frame, &json);
  if (frame.is_tracking) {
    AddPosture(body, frame.estimate, &json);
    if (details.with_segments) AddSegments(*body.setup.model, frame.estimate.posture, &json);
    if (details.with_anatomy && HasAnatomy(*body.setup.model)) {
      json.Key("anatomy");
      json.Open();
      json.AddAll(AnglesOf(body, frame.estimate.posture).values.col(0));
      json.Close();
    }
  }
  return json.Take();
}

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
