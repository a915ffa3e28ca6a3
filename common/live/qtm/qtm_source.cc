// SPDX-License-Identifier: MIT
#include "common/live/qtm/qtm_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "common/support/error.h"
#include "common/support/text.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kDiscoveryTime{1000};
constexpr int kPacketsAtOnce = 64;
constexpr std::size_t kMostAnnouncements = 16;  // that are told apart

}  // namespace

QtmSource::QtmSource(QtmSourceOptions options)
    : ConnectedSource(options.now), options_(std::move(options)) {}

void QtmSource::Wait(std::chrono::nanoseconds most) {
  const std::array sockets = {connection_.Waiting(), udp_ ? udp_->Waiting() : WaitFor()};
  if (has_more_) return;
  const bool has_limit = is_connected() && !is_paused_;
  WaitForSockets(sockets, has_limit ? std::min(most, limit_ - now()) : most);
}

void QtmSource::Disconnect() {
  connection_.Close();
  udp_.reset();
  is_paused_ = has_more_ = false;
}

void QtmSource::Go(Step step, milliseconds limit) {
  step_ = step;
  limit_ = now() + limit;
}

std::string QtmSource::Server() const {
  return options_.host.empty()
             ? "qtm://"
             : fmt::format("QTM at {}:{}", InAddress(options_.host), options_.port);
}

QtmSource::Event QtmSource::Advance(StreamFrame* frame) {
  if (step_ == Step::kDiscovering) return Discover();
  has_more_ = true;
  for (int i = 0; i < kPacketsAtOnce; ++i) {
    std::string_view packet;
    UdpAddress sender;
    if (connection_.Take(&packet)) {
      if (const Event event = Handle(packet, frame)) return event;
    } else if (const auto datagram = udp_ ? udp_->Receive(&sender) : std::nullopt) {
      received_ = std::chrono::steady_clock::now();
      if (const Event event = Handle(*datagram, frame)) return event;
    } else if (connection_.Receive()) {
      received_ = std::chrono::steady_clock::now();
    } else {
      has_more_ = false;
      break;
    }
    if (!is_connected()) return std::nullopt;
  }
  return CheckTime();
}

QtmSource::Event QtmSource::CheckTime() {
  if (!connection_.tcp().is_open()) {
    if (step_ == Step::kConnecting) {
      return Lose(connection_.tcp().failure(),
                  "start QTM there, and check the address, the port (22223 unless QTM's options of "
                  "the real-time output say otherwise) and the firewall");
    }
    if (connection_.tcp().failure().starts_with("what comes")) CountBroken();
    return Lose(connection_.tcp().failure());
  }
  if (step_ == Step::kConnecting && !connection_.tcp().is_connecting()) {
    Go(Step::kGreeting, kAnswerLimit);
  }
  if (now() < limit_ || (is_paused_ && !awaits_parameters_)) return std::nullopt;
  if (step_ == Step::kSoftware) {  // it can be done without
    AskForParameters();
    Go(Step::kParameters, kAnswerLimit);
    return std::nullopt;
  }
  if (step_ == Step::kConnecting) return Lose("no answer", "check the address and the firewall");
  if (step_ != Step::kStreaming || awaits_parameters_) {
    return Lose("it does not answer", "check that this is QTM's port of the real-time protocol");
  }
  if (!pause_reason_.empty()) return Pause(pause_reason_);
  return Lose(fmt::format("no labelled 3D data for {} s", kSilence.count() / 1000),
              "check that QTM tracks 3D in real time");
}

QtmSource::Event QtmSource::Connect() {
  udp_.reset();
  if (options_.host.empty()) {
    udp_.emplace("", 0);
    udp_->AllowBroadcast();
    const std::string request = FormatQtmDiscovery(static_cast<std::uint16_t>(udp_->port()));
    for (const char* host : {"255.255.255.255", "127.0.0.1"}) {
      udp_->Send(request, FindUdpAddress(host, options_.discovery_port));
    }
    announcements_.clear();
    Go(Step::kDiscovering, kDiscoveryTime);
    return std::nullopt;
  }
  if (options_.udp) udp_.emplace("", 0);
  minor_ = options_.newest_minor;
  is_paused_ = awaits_parameters_ = false;
  pause_reason_.clear();
  Go(Step::kConnecting, kAnswerLimit);
  connection_.Use(TcpConnection::To(options_.host, options_.port));
  return std::nullopt;
}

QtmSource::Event QtmSource::Discover() {
  UdpAddress sender;
  for (int i = 0; i < kPacketsAtOnce; ++i) {
    const auto datagram = udp_->Receive(&sender);
    if (!datagram) break;
    try {
      const QtmAnnouncement found = ParseQtmAnnouncement(*datagram);
      // A computer may answer from several of its addresses.
      const bool is_known =
          std::any_of(announcements_.begin(), announcements_.end(), [&](const auto& other) {
            return other.second.text == found.text && other.second.base_port == found.base_port;
          });
      if (!is_known && announcements_.size() < kMostAnnouncements)
        announcements_.emplace_back(sender, found);
    } catch (const Error&) {
      CountBroken();
    }
  }
  if (now() < limit_) return std::nullopt;
  if (announcements_.empty()) {
    return Lose("no QTM answers in this network",
                "start QTM, or give its address, as in qtm://192.168.1.10");
  }
  std::vector<std::string> found;
  for (const auto& [address, announcement] : announcements_) {
    found.push_back(fmt::format("qtm://{}:{} ({})", FormatIp(address), announcement.base_port + 1,
                                ToUtf8(announcement.text)));
  }
  if (found.size() > 1) return Lose("several QTM answer", "choose " + JoinNames(found));
  options_.host = FormatIp(announcements_.front().first);
  options_.port = announcements_.front().second.base_port + 1;
  ConnectAnew();
  return std::nullopt;
}

QtmSource::Event QtmSource::Pause(const std::string& reason) {
  is_paused_ = true;
  pause_reason_.clear();
  return Say(fmt::format("{}: {}", Server(), reason));
}

QtmSource::Event QtmSource::FillFrame(StreamFrame* frame) {
  frame->number = data_.frame;
  frame->time = layout().rate > 0 ? data_.frame / layout().rate
                                  : static_cast<double>(data_.camera_time) * 1e-6;
  frame->received = received_;
  frame->points.resize(3, static_cast<Eigen::Index>(data_.labelled.size()));
  FillPoints(data_.labelled, frame->points);
  SetUnnamed(data_.unlabelled.size(), frame);
  FillPoints(data_.unlabelled, frame->unnamed_points.leftCols(frame->unnamed));
  return CountFrame(frame->number);
}

void QtmSource::FillPoints(const std::vector<QtmPoint>& from,
                           Eigen::Ref<Eigen::Matrix3Xd> to) const {
  for (Eigen::Index i = 0; i < to.cols(); ++i) {
    const float* p = from[static_cast<std::size_t>(i)].position;
    const Eigen::Vector3d lab(p[0], p[1], p[2]);
    if (lab.allFinite()) {
      to.col(i).noalias() = rotation_ * lab;
    } else {
      to.col(i).setConstant(kNaN);
    }
  }
}

std::unique_ptr<FrameSource> OpenQtmSource(const StreamAddress& address, bool needs_labels) {
  address.AllowOnly({"version", "udp", "discovery"});
  QtmSourceOptions options;
  options.needs_labels = needs_labels;
  options.host = address.host;
  options.port = address.port.value_or(options.port);
  options.udp = address.GetSwitch("udp");
  options.discovery_port = address.GetPort("discovery").value_or(options.discovery_port);
  if (const auto version = address.Get("version")) {
    const auto minor = version->starts_with("1.") ? ParseLong(version->substr(2)) : std::nullopt;
    if (!minor || *minor < kOldestQtmMinor || *minor > kNewestQtmMinor) {
      throw Error(fmt::format("{}: version is \"{}\"; it must be 1.{} to 1.{}", address.text,
                              *version, kOldestQtmMinor, kNewestQtmMinor));
    }
    options.newest_minor = static_cast<int>(*minor);
  }
  return std::make_unique<QtmSource>(std::move(options));
}

}  // namespace mmm_converter
