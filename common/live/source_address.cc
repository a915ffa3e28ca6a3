// SPDX-License-Identifier: MIT
#include "common/live/source_address.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>
#include <vector>

#include "common/live/natnet/natnet_source.h"
#include "common/live/qtm/qtm_source.h"
#include "common/live/replay/replay_source.h"
#include "common/live/stream_address.h"
#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

struct SourceKind {
  std::string_view start;  ///< of its addresses, in lower case
  const char* form;
  const char* description;
  LiveSource (*open)(const std::string& address, const SourceOptions& options, Warnings* warnings);
  std::string (*file)(const std::string& address);
};

template <std::unique_ptr<FrameSource> (*Open)(const StreamAddress&, bool)>
LiveSource OpenStream(const std::string& address, const SourceOptions& options,
                      Warnings* /*warnings*/) {
  LiveSource live;
  live.head.file = address;
  live.head.format = "live stream";
  live.head.unit = "m";
  live.source = Open(ParseStreamAddress(address), options.needs_labels);
  live.selects_labels = true;
  return live;
}

std::string NoFile(const std::string& /*address*/) { return ""; }

constexpr std::string_view kReplay = "replay:";

ReplayAddress Replayed(const std::string& address) {
  return ParseReplayAddress(address.substr(kReplay.size()));
}

LiveSource OpenReplay(const std::string& address, const SourceOptions& options,
                      Warnings* warnings) {
  const ReplayAddress replayed = Replayed(address);
  LiveSource live;
  live.head = ReadRecording(replayed.file, options.reading, warnings);
  live.head.format = "replay";
  if (live.head.mmm) live.head.mmm->num_motions = 1;
  MarkerSequence markers = live.head.markers;
  live.source = std::make_unique<ReplaySource>(
      std::move(markers), live.head.first_frame,
      PlaybackOptions{.speed = replayed.speed, .loop = options.loops}, replayed.file);
  return live;
}

// A new source is a folder and a row.
constexpr std::array kSourceKinds = {
    SourceKind{"qtm://", "qtm://HOST[:PORT]",
               "Qualisys QTM; without a host: the one of the network", OpenStream<OpenQtmSource>,
               NoFile},
    SourceKind{"natnet://", "natnet://HOST[:PORT]",
               "OptiTrack Motive; ?multicast=GROUP, ?up=z, ?local=ADDRESS",
               OpenStream<OpenNatNetSource>, NoFile},
    SourceKind{kReplay, "replay:FILE[@SPEED]",
               "a recording; @2: twice as fast, @max: as fast as possible", OpenReplay,
               [](const std::string& address) { return Replayed(address).file; }}};

const SourceKind& KindOf(const std::string& address) {
  const std::string lower = ToLower(address);
  std::vector<std::string> forms;
  for (const SourceKind& kind : kSourceKinds) {
    if (lower.starts_with(kind.start)) return kind;
    forms.emplace_back(kind.form);
  }
  if (address.find("://") == std::string::npos) {
    throw Error(fmt::format("\"{}\" is no source of frames; use {}", address, JoinNames(forms)));
  }
  throw Error(fmt::format("{}: there is no source of the kind \"{}\"; use {}", address,
                          ParseStreamAddress(address).scheme, JoinNames(forms)));
}

}  // namespace

LiveSource OpenLiveSource(const std::string& address, const SourceOptions& options,
                          Warnings* warnings) {
  return KindOf(address).open(address, options, warnings);
}

std::unique_ptr<FrameSource> OpenSource(const std::string& address, bool needs_labels) {
  return OpenLiveSource(address, {.needs_labels = needs_labels}).source;
}

std::string FileOfSource(const std::string& address) { return KindOf(address).file(address); }

std::string DescribeSources() {
  std::string text;
  for (const SourceKind& kind : kSourceKinds) {
    text += fmt::format("  {:<24} {}\n", kind.form, kind.description);
  }
  return text;
}

}  // namespace mmm_converter
