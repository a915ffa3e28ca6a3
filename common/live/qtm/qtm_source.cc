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

constexpr milliseconds kAnswerLimit{5000};
constexpr milliseconds kDiscoveryTime{1000};
constexpr milliseconds kSilence{5000};       // of a stream: it is lost
constexpr milliseconds kShortSilence{1000};  // after an event that says so
constexpr milliseconds kFirstRetry{500};
constexpr milliseconds kLongestRetry{8000};
constexpr int kPacketsAtOnce = 64;
constexpr std::int64_t kMostLostAtOnce = 1000000;  // else the numbers begin anew
constexpr std::int64_t kMostLate = 1000;

}  // namespace

QtmSource::QtmSource(QtmSourceOptions options)
    : options_(std::move(options)), retry_at_(options_.now()), retry_wait_(kFirstRetry) {}

StreamEvent QtmSource::Next(milliseconds wait, StreamFrame* frame) {
  const SteadyTime end = std::chrono::steady_clock::now() + wait;
  while (true) {
    if (const Event event = Advance(frame)) return *event;
    const auto left = std::chrono::ceil<milliseconds>(end - std::chrono::steady_clock::now());
    if (left.count() <= 0) return StreamEvent::kNothing;
    Wait(left);
  }
}

void QtmSource::Wait(milliseconds most) {
  const SteadyTime until = step_ == Step::kWaiting ? retry_at_ : limit_;
  const auto left = std::chrono::ceil<milliseconds>(until - options_.now());
  const std::array sockets = {connection_.Waiting(), udp_ ? udp_->Waiting() : WaitFor()};
  if (has_more_) most = milliseconds(0);
  WaitForSockets(sockets, is_paused_ ? most : std::min(most, left));
}

void QtmSource::Go(Step step, milliseconds limit) {
  step_ = step;
  limit_ = options_.now() + limit;
}

std::string QtmSource::Server() const {
  return fmt::format("QTM at {}:{}", options_.host, options_.port);
}

QtmSource::Event QtmSource::Advance(StreamFrame* frame) {
  if (data_is_pending_) return FillFrame(frame);
  if (step_ == Step::kWaiting) {
    if (options_.now() < retry_at_) return std::nullopt;
    if (const Event event = Connect()) return event;
  }
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
    if (step_ == Step::kWaiting) break;
  }
  has_more_ = has_more_ && step_ != Step::kWaiting;
  return step_ == Step::kWaiting ? std::nullopt : CheckTime();
}

QtmSource::Event QtmSource::CheckTime() {
  if (!connection_.tcp().is_open()) {
    if (step_ == Step::kConnecting) {
      return Lose(connection_.tcp().failure(),
                  "start QTM there, and check the address, the port (22223 unless QTM's options of "
                  "the real-time output say otherwise) and the firewall");
    }
    counts_.broken += connection_.tcp().failure().starts_with("what comes") ? 1 : 0;
    return Lose(connection_.tcp().failure());
  }
  if (step_ == Step::kConnecting && !connection_.tcp().is_connecting()) {
    ++counts_.connections;
    Go(Step::kGreeting, kAnswerLimit);
  }
  if (options_.now() < limit_ || (is_paused_ && !awaits_parameters_)) return std::nullopt;
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
  last_number_ = -1;
  Go(Step::kConnecting, kAnswerLimit);
  connection_.Use(TcpConnection::To(options_.host, options_.port));
  return std::nullopt;
}

QtmSource::Event QtmSource::Discover() {
  UdpAddress sender;
  while (const auto datagram = udp_->Receive(&sender)) {
    try {
      const QtmAnnouncement found = ParseQtmAnnouncement(*datagram);
      // A computer may answer from several of its addresses.
      const bool is_known =
          std::any_of(announcements_.begin(), announcements_.end(), [&](const auto& other) {
            return other.second.text == found.text && other.second.base_port == found.base_port;
          });
      if (!is_known) announcements_.emplace_back(sender, found);
    } catch (const Error&) {
      ++counts_.broken;
    }
  }
  if (options_.now() < limit_) return std::nullopt;
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
  retry_at_ = options_.now();
  step_ = Step::kWaiting;
  return std::nullopt;
}

QtmSource::Event QtmSource::Lose(const std::string& reason, const std::string& remedy) {
  const std::string whole = fmt::format("{}: {}{}{}", options_.host.empty() ? "qtm://" : Server(),
                                        reason, remedy.empty() ? "" : "; ", remedy);
  connection_.Close();
  udp_.reset();
  if (!had_layout_) throw Error(whole);
  step_ = Step::kWaiting;
  is_paused_ = false;
  retry_at_ = options_.now() + retry_wait_;
  retry_wait_ = std::min(2 * retry_wait_, kLongestRetry);
  return Say(whole);
}

QtmSource::Event QtmSource::Pause(const std::string& reason) {
  is_paused_ = true;
  pause_reason_.clear();
  return Say(fmt::format("{}: {}", Server(), reason));
}

QtmSource::Event QtmSource::Say(const std::string& reason) {
  if (is_lost_) return std::nullopt;
  is_lost_ = layout_is_due_ = true;
  message_ = reason;
  return StreamEvent::kLost;
}

void QtmSource::CountLost(std::int64_t number) {
  const std::int64_t gap = number - last_number_ - 1;
  if (last_number_ >= 0 && gap > 0 && gap < kMostLostAtOnce) counts_.lost += gap;
  // What comes late by UDP is not counted twice; a stream that starts anew is followed.
  if (gap >= 0 || gap < -kMostLate) last_number_ = number;
}

QtmSource::Event QtmSource::FillFrame(StreamFrame* frame) {
  data_is_pending_ = false;
  frame->number = data_.frame;
  frame->time =
      layout_.rate > 0 ? data_.frame / layout_.rate : static_cast<double>(data_.camera_time) * 1e-6;
  frame->received = received_;
  frame->unnamed = static_cast<int>(data_.unlabelled.size());
  frame->points.resize(3, static_cast<Eigen::Index>(data_.labelled.size()));
  for (Eigen::Index i = 0; i < frame->points.cols(); ++i) {
    const float* p = data_.labelled[static_cast<std::size_t>(i)].position;
    const Eigen::Vector3d lab(p[0], p[1], p[2]);
    if (lab.allFinite()) {
      frame->points.col(i).noalias() = rotation_ * lab;
    } else {
      frame->points.col(i).setConstant(kNaN);
    }
  }
  CountLost(frame->number);
  ++counts_.frames;
  return StreamEvent::kFrame;
}

std::unique_ptr<FrameSource> OpenQtmSource(const StreamAddress& address) {
  address.AllowOnly({"version", "udp", "discovery"});
  QtmSourceOptions options;
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
