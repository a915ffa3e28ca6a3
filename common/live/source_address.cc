// SPDX-License-Identifier: MIT
#include "common/live/source_address.h"

#include <fmt/format.h>

#include <array>
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
  const char* scheme;
  const char* form;
  const char* description;
  std::unique_ptr<FrameSource> (*open)(const StreamAddress& address, bool needs_labels);
};

constexpr std::string_view kReplay = "replay:";
constexpr const char* kReplayForm = "replay:FILE[@SPEED]";

// A new source is a folder and a row.
constexpr std::array kSourceKinds = {
    SourceKind{"qtm", "qtm://HOST[:PORT]", "Qualisys QTM; without a host: the one of the network",
               OpenQtmSource},
    SourceKind{"natnet", "natnet://HOST[:PORT]",
               "OptiTrack Motive; ?multicast=GROUP, ?up=z, ?local=ADDRESS", OpenNatNetSource}};

}  // namespace

std::unique_ptr<FrameSource> OpenSource(const std::string& address, bool needs_labels) {
  if (address.starts_with(kReplay)) return OpenReplay(address.substr(kReplay.size()));
  std::vector<std::string> forms = {kReplayForm};
  for (const SourceKind& kind : kSourceKinds) forms.emplace_back(kind.form);
  if (address.find("://") == std::string::npos) {
    throw Error(fmt::format("\"{}\" is no source of frames; use {}", address, JoinNames(forms)));
  }
  const StreamAddress parsed = ParseStreamAddress(address);
  for (const SourceKind& kind : kSourceKinds) {
    if (parsed.scheme == kind.scheme) return kind.open(parsed, needs_labels);
  }
  throw Error(fmt::format("{}: there is no source of the kind \"{}\"; use {}", address,
                          parsed.scheme, JoinNames(forms)));
}

std::string DescribeSources() {
  std::string text;
  for (const SourceKind& kind : kSourceKinds) {
    text += fmt::format("  {:<24} {}\n", kind.form, kind.description);
  }
  return text + fmt::format("  {:<24} {}\n", kReplayForm,
                            "a recording; @2: twice as fast, @max: as fast as possible");
}

}  // namespace mmm_converter
