// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "common/support/text_pieces.h"

namespace mmm_converter {

/// Replaces or creates the file at `path` with `content`, whole or not at all: the bytes go to a
/// temporary file in the same folder that is then renamed, so that a reader never sees half of them
/// and an existing file stays as it was where anything fails. A symbolic link stays one: its target
/// is replaced. An existing file keeps its permissions; a new one gets what the process's umask
/// allows. Something other than a regular file, such as /dev/stdout or a pipe, is written to
/// directly. What killed processes left in the folder is removed when a process first writes there.
/// @throws Error naming the path and the system's reason; WriteError where the system refused (no
/// permission, no space).
void WriteFileAtomically(const std::string& path, std::string_view content);

/// The same for a text that is made while it is written. Where making it throws, nothing is
/// changed; only what is written to directly then ends early.
void WriteFileAtomically(const std::string& path, const TextPieces& content);

/// While it lives, what this thread writes is put on the disk but replaces nothing yet. Commit
/// gives all files their names; where it is not reached, because making one of them failed or the
/// disk is full, all is as it was. Within another one it does nothing by itself.
class FilesTogether {
 public:
  FilesTogether();
  ~FilesTogether();
  FilesTogether(const FilesTogether&) = delete;
  FilesTogether& operator=(const FilesTogether&) = delete;

  /// @throws WriteError
  void Commit();

 private:
  friend void WriteFileAtomically(const std::string& path, const TextPieces& content);
  class Held;

  bool is_outermost_;
  std::vector<std::unique_ptr<Held>> held_;
};

/// Opens a pipe that will be written, so that one without reader is an error now and not after the
/// work; nothing where `path` is none. @throws Error
void HoldPipe(const std::string& path);

/// Removes from a folder what WriteFileAtomically left there when its process was killed. What
/// processes that are alive are writing stays, on other machines too as far as the file system has
/// locks.
void RemoveAbandonedFiles(const std::string& folder);

}  // namespace mmm_converter
