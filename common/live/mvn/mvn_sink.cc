// SPDX-License-Identifier: MIT
#include "common/live/mvn/mvn_sink.h"

#include <fmt/format.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/udp.hpp>
#include <cmath>
#include <optional>

#include "common/live/mvn/mvn_body.h"
#include "common/live/stream_address.h"
#include "common/support/error.h"

namespace mmm_converter {
namespace {

using boost::asio::ip::udp;

constexpr int kMvnPort = 9763;

class MvnSink : public PoseSink {
 public:
  explicit MvnSink(const std::string& address) : name_(address), socket_(context_) {
    const StreamAddress parsed = ParseStreamAddress(address);
    parsed.AllowOnly({});
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
      if (!first_time_) first_time_ = frame.time;
    }
    const double milliseconds = std::fmod(1000 * (frame.time - *first_time_), 4294967296.0);
    const std::string packet =
        FormatMvnPacket(static_cast<std::uint32_t>(frame.number),
                        static_cast<std::uint32_t>(std::max(0.0, milliseconds)),
                        mvn_body_->Poses(*body->setup.model, frame.estimate.posture));
    // Nobody has to listen: what can't be sent now is lost, as UDP is.
    boost::system::error_code lost;
    socket_.send_to(boost::asio::buffer(packet), target_, 0, lost);
  }

 private:
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
