// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include "MMMConverterS2KF/live/live_request.h"
#include "common/io/recording/recording.h"
#include "common/live/frame_source.h"
#include "common/support/warnings.h"

namespace mmm_converter {

struct LiveSource {
  std::unique_ptr<FrameSource> source;
  Recording head;               ///< what is known beyond its frames; of a replay the file's person
  bool selects_labels = false;  ///< the labels are as the source has them, with prefixes
};

/// The recording that a replay's address names; empty for other sources.
/// @throws Error as ParseReplayAddress.
std::string ReplayedFile(const std::string& address);

/// The source of an address, as the user wrote it.
/// @throws Error naming the kinds that there are.
LiveSource OpenLiveSource(const LiveRequest& request, Warnings* warnings);

}  // namespace mmm_converter
