// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include "common/live/frame_source.h"

namespace mmm_converter {

/// The source that an address names: "qtm://192.168.1.10", "natnet://192.168.1.10?up=z",
/// "replay:walk.c3d@2". Nothing is connected to yet. needs_labels: a system that has no labels is
/// an error, for whoever does not name points.
/// @throws Error where the address is not understood, which names the known kinds of sources.
std::unique_ptr<FrameSource> OpenSource(const std::string& address, bool needs_labels = true);

/// The kinds of sources, for a help text: one line each.
std::string DescribeSources();

}  // namespace mmm_converter
