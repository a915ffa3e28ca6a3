// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/live/live_source.h"

#include <string_view>
#include <utility>

#include "common/live/replay/replay_source.h"
#include "common/live/source_address.h"

namespace mmm_converter {
namespace {

constexpr std::string_view kReplay = "replay:";

LiveSource OpenRecording(const LiveRequest& request, Warnings* warnings) {
  const ReplayAddress address = ParseReplayAddress(request.input.file.substr(kReplay.size()));
  LiveSource live;
  ReadRecordingOptions reading = request.input.reading;
  reading.with_unlabelled = request.label;
  live.head = ReadRecording(address.file, reading, warnings);
  live.head.format = "replay";
  if (live.head.mmm) live.head.mmm->num_motions = 1;
  MarkerSequence markers = std::move(live.head.markers);
  live.source = std::make_unique<ReplaySource>(
      std::move(markers), live.head.first_frame,
      PlaybackOptions{.speed = address.speed, .loop = request.loops}, address.file);
  return live;
}

}  // namespace

std::string ReplayedFile(const std::string& address) {
  return address.starts_with(kReplay) ? ParseReplayAddress(address.substr(kReplay.size())).file
                                      : "";
}

LiveSource OpenLiveSource(const LiveRequest& request, Warnings* warnings) {
  const std::string& address = request.input.file;
  if (address.starts_with(kReplay)) return OpenRecording(request, warnings);
  LiveSource live;
  live.head.file = address;
  live.head.format = "live stream";
  live.head.unit = "m";
  live.source = OpenSource(address, !request.label);
  live.selects_labels = true;
  return live;
}

}  // namespace mmm_converter
