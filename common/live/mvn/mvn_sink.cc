// SPDX-License-Identifier: MIT
#include "common/live/mvn/mvn_sink.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/udp.hpp>
#include <cmath>
#include <optional>
#include <sstream>
#include <vector>

#include "common/live/mvn/mvn_body.h"
#include "common/live/stream_address.h"
#include "common/support/error.h"

namespace mmm_converter {
namespace {

using boost::asio::ip::udp;

constexpr int kMvnPort = 9763;
constexpr std::array<const char*, 5> kKinds = {"02", "12", "13", "20", "25"};
constexpr double kTellEvery = 1;  // [s], of name and size: who comes later gets them too

class MvnSink : public PoseSink {
 public:
  explicit MvnSink(const std::string& address) : name_(address), socket_(context_) {
    const StreamAddress parsed = ParseStreamAddress(address);
    parsed.AllowOnly({"kinds"});
    if (const auto kinds = parsed.Get("kinds")) kinds_ = ReadKinds(address, *kinds);
    boost::system::error_code failure;
    udp::resolver resolver(context_);
    const auto found = resolver.resolve(parsed.HostOr("127.0.0.1"),
                                        std::to_string(parsed.port.value_or(kMvnPort)), failure);
    if (failure) throw Error(fmt::format("{}: {}", address, failure.message()));
    target_ = found.begin()->endpoint();
    socket_.open(target_.protocol(), failure);
    if (!failure) socket_.non_blocking(true, failure);
    if (failure) throw Error(fmt::format("{}: {}", address, failure.message()));
  }

  std::string name() const override { return name_; }

  void Write(const std::shared_ptr<const LiveBody>& body, const PoseFrame& frame) override {
    if (!frame.is_tracking) return;
    if (body != body_) {
      mvn_body_.emplace(*body->setup.model);
      body_ = body;
      told_.reset();
      if (!first_time_) first_time_ = frame.time;
    }
    const double milliseconds = std::fmod(1000 * (frame.time - *first_time_), 4294967296.0);
    const MvnMoment moment = {static_cast<std::uint32_t>(frame.number),
                              static_cast<std::uint32_t>(std::max(0.0, milliseconds))};
    const KinematicModel& model = *body->setup.model;
    if (!told_ || std::abs(frame.time - *told_) >= kTellEvery) {
      told_ = frame.time;
      if (IsSent("12")) Send(FormatMvnName(moment, body->name));
      if (IsSent("13")) Send(FormatMvnScale(moment, mvn_body_->TPose(model)));
    }
    const MvnPoses poses = mvn_body_->Poses(model, frame.estimate.posture);
    if (IsSent("02")) Send(FormatMvnPoses(moment, poses));
    if (IsSent("20")) Send(FormatMvnJointAngles(moment, poses));
    if (IsSent("25")) Send(FormatMvnTimeCode(moment));
  }

 private:
  static std::vector<std::string> ReadKinds(const std::string& address, const std::string& text) {
    std::vector<std::string> kinds;
    std::istringstream words(text);
    for (std::string kind; std::getline(words, kind, ',');) {
      if (std::find(kKinds.begin(), kKinds.end(), kind) == kKinds.end()) {
        throw Error(fmt::format("{}: there is no kind \"{}\" of datagrams; kinds are {}", address,
                                kind, fmt::join(kKinds, ", ")));
      }
      kinds.push_back(kind);
    }
    if (kinds.empty()) {
      throw Error(fmt::format("{}: kinds are {}", address, fmt::join(kKinds, ", ")));
    }
    return kinds;
  }

  bool IsSent(const char* kind) const {
    return std::find(kinds_.begin(), kinds_.end(), kind) != kinds_.end();
  }

  // Nobody has to listen: what can't be sent now is lost, as UDP is.
  void Send(const std::string& datagram) {
    boost::system::error_code lost;
    socket_.send_to(boost::asio::buffer(datagram), target_, 0, lost);
  }

  std::vector<std::string> kinds_ = {"02"};
  std::optional<double> told_;  // when name and size were sent
  std::string name_;
  boost::asio::io_context context_;
  udp::socket socket_;
  udp::endpoint target_;
  std::shared_ptr<const LiveBody> body_;
  std::optional<MvnBody> mvn_body_;
  std::optional<double> first_time_;
};

}  // namespace

std::unique_ptr<PoseSink> OpenMvnSink(const std::string& address) {
  return std::make_unique<MvnSink>(address);
}

}  // namespace mmm_converter
