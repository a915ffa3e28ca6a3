// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "common/io/recording/recording.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// How a file begins.
struct FileStart {
  std::string path;
  std::string head;  ///< its first MiB at most
  std::string root;  ///< name of the root element of XML or HTML; empty: it is neither
};

/// What a file is and what is in it.
struct Description {
  std::string text;
  std::string json;
  Warnings warnings;
};

/// A kind of file that the program reads or writes: a row of a table in which the first that
/// recognises a file describes it.
struct FileKind {
  const char* name;  ///< for messages: "motions (MMM)"
  bool (*is)(const FileStart& file);
  /// @throws Error where the file can't be read as what it seems to be.
  Description (*describe)(const FileStart& file, const ReadRecordingOptions& options);
};

/// All kinds but those of a batch.
const std::vector<FileKind>& FileKinds();

/// options: for recordings. @throws Error where the file can't be read or is of none of the kinds.
Description DescribeFile(const std::string& path, const ReadRecordingOptions& options,
                         const std::vector<FileKind>& kinds);

}  // namespace mmm_converter
