// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/motion/recording_content.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// A format of recordings. A row of the table is all that the program needs to know of one.
struct RecordingFormat {
  const char* name;                  ///< for messages: "C3D"
  std::vector<const char*> endings;  ///< of file names, in lower case: ".c3d"
  /// Whether the file can be of the format; start: its first bytes.
  bool (*looks_like)(const std::string& file, std::string_view start);
  RecordingContent (*read)(const std::string& file, const ContentOptions& options,
                           Warnings* warnings);
  int memory_factor;                ///< bytes that a conversion takes at most for each of the file
  bool is_written = false;          ///< recordings are written in it, too
  bool holds_motions = false;       ///< too: files of other programs' results have the same format
  bool is_told_by_content = false;  ///< other tables have the same endings
};

/// In the order in which they are named in messages.
const std::vector<RecordingFormat>& RecordingFormats();

/// "C3D, TRC, ... or MMM motion"
std::string RecordingFormatNames();

/// The first one with the ending of the file's name, whether it is there or not; null: the ending
/// is of no format.
const RecordingFormat* FindFormatOfName(const std::string& file);

/// By the content; null: it is of no format.
/// @throws Error where the file can't be read.
const RecordingFormat* FindFormatOfContent(const std::string& file);

/// As FindFormatOfContent, never null.
/// @throws Error also where the file is of no format: what it is instead.
const RecordingFormat& FormatOfContent(const std::string& file);

}  // namespace mmm_converter
