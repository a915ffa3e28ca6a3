// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include "common/io/recording/recording.h"
#include "common/live/frame_source.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// How a source is opened; what a kind has no use for does not count.
struct SourceOptions {
  bool needs_labels = true;  ///< a system that has no labels is an error
  ReadRecordingOptions reading = {};
  bool loops = false;  ///< a recording begins again at its end
};

/// A source, and what is known of its stream beyond the frames.
struct LiveSource {
  std::unique_ptr<FrameSource> source;
  Recording head;               ///< of a recording all of it
  bool selects_labels = false;  ///< the labels are as the source has them, with prefixes
};

/// The source that an address names: "qtm://192.168.1.10", "natnet://192.168.1.10?up=z",
/// "replay:walk.c3d@2". Nothing is connected to yet. warnings: of a recording.
/// @throws Error where the address is not understood, which names the known kinds of sources.
LiveSource OpenLiveSource(const std::string& address, const SourceOptions& options,
                          Warnings* warnings = nullptr);

/// Its source alone.
std::unique_ptr<FrameSource> OpenSource(const std::string& address, bool needs_labels = true);

/// The file that the source of an address reads; empty: none. @throws Error as OpenLiveSource.
std::string FileOfSource(const std::string& address);

/// The kinds of sources, for a help text: one line each.
std::string DescribeSources();

}  // namespace mmm_converter
