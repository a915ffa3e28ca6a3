// SPDX-License-Identifier: MIT
// What QtmSource does with what comes.
#include <fmt/format.h>

#include "common/live/qtm/qtm_source.h"
#include "common/live/wire/broken_message.h"
#include "common/support/error.h"
#include "common/support/text.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kSoftwareLimit{1000};
constexpr milliseconds kQuietAfterStop{1000};
constexpr milliseconds kAskAgainAfter{1000};
constexpr std::size_t kMostTextBytes = 500;  // that are repeated in messages
constexpr const char* kGreetingText = "QTM RT Interface connected";
constexpr const char* kSoftwareText = "QTM Version is ";

}  // namespace

QtmSource::Event QtmSource::Handle(std::string_view bytes, StreamFrame* frame) {
  try {
    const QtmPacket packet = ParseQtmPacket(bytes);
    switch (packet.type) {
      case QtmPacketType::kError:
      case QtmPacketType::kCommand:
        return HandleText(packet);
      case QtmPacketType::kXml:
        return HandleParameters(packet);
      case QtmPacketType::kData:
        return HandleData(packet, frame);
      case QtmPacketType::kNoMoreData:
        if (step_ != Step::kStreaming || is_paused_) return std::nullopt;
        return Pause(pause_reason_.empty() ? "QTM measures nothing at present" : pause_reason_);
      case QtmPacketType::kEvent:
        return HandleEvent(ParseQtmEvent(packet));
      default:
        return std::nullopt;
    }
  } catch (const BrokenMessage&) {
    CountBroken();
    return std::nullopt;
  }
}

QtmSource::Event QtmSource::HandleText(const QtmPacket& packet) {
  const std::string text = ToUtf8(QtmText(packet).substr(0, kMostTextBytes));
  const bool is_error = packet.type == QtmPacketType::kError;
  switch (step_) {
    case Step::kConnecting:
    case Step::kGreeting:
      if (is_error) {
        return Lose(fmt::format("it refuses the connection (\"{}\")", text),
                    "end another program that is connected to it");
      }
      if (!text.starts_with(kGreetingText)) {
        return Lose(fmt::format("it says \"{}\", which QTM does not", text.substr(0, 60)),
                    "check the port");
      }
      CountConnection();
      connection_.SendCommand(fmt::format("Version 1.{}", minor_));
      Go(Step::kVersion, kAnswerLimit);
      return std::nullopt;
    case Step::kVersion:
      return HandleVersion(packet);
    case Step::kSoftware:
      if (!is_error) {
        software_ = text.starts_with(kSoftwareText)
                        ? "QTM " + text.substr(std::string_view(kSoftwareText).size())
                        : text;
      }
      AskForParameters();
      Go(Step::kParameters, kAnswerLimit);
      return std::nullopt;
    case Step::kParameters:
      if (!is_error) return std::nullopt;
      return Lose(fmt::format("it gives no parameters (\"{}\")", text),
                  "open a file or a new measurement in QTM");
    case Step::kStreaming:
      if (!is_error) return std::nullopt;
      if (awaits_parameters_) {
        return Lose(fmt::format("it gives no parameters any more (\"{}\")", text));
      }
      if (asks_for_unlabelled_) {
        asks_for_unlabelled_ = false;
        StartStream();
        return std::nullopt;
      }
      return Lose(fmt::format("it refuses to stream 3D data (\"{}\")", text),
                  "check that QTM tracks 3D in real time");
    default:
      return std::nullopt;
  }
}

QtmSource::Event QtmSource::HandleVersion(const QtmPacket& packet) {
  const std::string text = ToUtf8(QtmText(packet).substr(0, kMostTextBytes));
  if (packet.type == QtmPacketType::kCommand && ToLower(text).starts_with("version set to")) {
    connection_.SendCommand("QTMVersion");
    software_ = "QTM";
    Go(Step::kSoftware, kSoftwareLimit);
    return std::nullopt;
  }
  if (--minor_ < kOldestQtmMinor) {
    return Lose(fmt::format("it speaks none of the versions 1.{} to 1.{} of the real-time protocol "
                            "(\"{}\")",
                            options_.newest_minor, kOldestQtmMinor, text),
                "update QTM");
  }
  connection_.SendCommand(fmt::format("Version 1.{}", minor_));
  Go(Step::kVersion, kAnswerLimit);
  return std::nullopt;
}

QtmSource::Event QtmSource::HandleEvent(QtmEvent event) {
  switch (event) {
    case QtmEvent::kConnectionClosed:
      return step_ == Step::kStreaming ? Lose("QTM has closed its measurement") : std::nullopt;
    case QtmEvent::kShuttingDown:
      return Lose("QTM is shutting down");
    case QtmEvent::kCaptureStopped:
    case QtmEvent::kRtFromFileStopped:
      if (step_ != Step::kStreaming || is_paused_) return std::nullopt;
      pause_reason_ = event == QtmEvent::kCaptureStopped ? "QTM has stopped the measurement"
                                                         : "QTM has stopped playing the file";
      if (!awaits_parameters_) limit_ = now() + kQuietAfterStop;
      return std::nullopt;
    case QtmEvent::kCaptureStarted:
    case QtmEvent::kRtFromFileStarted:
      restarts_stream_ = true;
      [[fallthrough]];
    case QtmEvent::kCalibrationStarted:
    case QtmEvent::kCalibrationStopped:
    case QtmEvent::kCameraSettingsChanged:
      if (step_ == Step::kStreaming) AskForParameters();
      return std::nullopt;
    default:
      return std::nullopt;
  }
}

void QtmSource::AskForParameters() {
  if (!awaits_parameters_) connection_.SendCommand("GetParameters General 3D");
  awaits_parameters_ = true;
  asked_at_ = now();
  limit_ = now() + kAnswerLimit;
}

void QtmSource::StartStream() {
  connection_.SendCommand(fmt::format("StreamFrames AllFrames {}3D{}",
                                      udp_ ? fmt::format("UDP:{} ", udp_->port()) : "",
                                      asks_for_unlabelled_ ? " 3DNoLabels" : ""));
  restarts_stream_ = false;
  Go(Step::kStreaming, kSilence);
}

QtmSource::Event QtmSource::HandleParameters(const QtmPacket& packet) {
  if (!awaits_parameters_) return std::nullopt;
  awaits_parameters_ = false;
  const bool is_first = step_ == Step::kParameters;
  try {
    parameters_ = ParseQtmParameters(QtmText(packet));
  } catch (const Error& error) {
    CountBroken();
    return Lose(fmt::format("its parameters can't be read ({})", error.what()));
  }
  if (parameters_.calibration_time && Trim(*parameters_.calibration_time).empty()) {
    return Lose("it is not calibrated, so that it knows no positions", "calibrate it in QTM");
  }
  if (parameters_.labels.empty() && options_.needs_labels) {
    return Lose(
        "it has no labelled markers",
        "label the markers in QTM, or apply an AIM model, in real time too; or have the points "
        "named by the body");
  }
  rotation_ = RotationToZUp(parameters_.up_axis) / kMillimetres;
  const Event event = TakeLayout(
      {fmt::format("{}, protocol 1.{}", software_, minor_), parameters_.labels, parameters_.rate});
  if (!is_connected()) return event;
  if (is_first || restarts_stream_ || is_paused_) {
    is_paused_ = false;
    pause_reason_.clear();
    StartStream();
  } else {
    limit_ = now() + kSilence;
  }
  return event;
}

QtmSource::Event QtmSource::HandleData(const QtmPacket& packet, StreamFrame* frame) {
  if (step_ != Step::kStreaming || awaits_parameters_) return std::nullopt;
  ParseQtmData(packet.body, &data_);
  if (!data_.has_labelled) return std::nullopt;
  if (data_.labelled.size() != layout().labels.size()) {
    if (now() < asked_at_ + kAskAgainAfter) {
      CountBroken();
    } else {
      AskForParameters();
    }
    return std::nullopt;
  }
  limit_ = now() + kSilence;
  is_paused_ = false;
  pause_reason_.clear();
  return FrameCame(frame);
}

}  // namespace mmm_converter
