// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "MMMConverterS2KF/batch/journal.h"
#include "MMMConverterS2KF/batch/manifest.h"

namespace mmm_converter {

/// Where an entry's files are, relative to the output folder.
/// The motion is MMM's, of a model of OpenSim a .mot.
std::string MotionPath(const BatchEntry& entry);
std::string ExportPath(const std::string& format, const std::string& id);
std::string SubjectPath(const std::string& id);
std::string RobotPath(const std::string& id);  ///< the robot's motion
std::string PagePath(const std::string& id);

inline constexpr const char* kOutdated = ".outdated";

/// The output folder of a batch. For several threads.
class BatchFolder {
 public:
  /// Creates it where it is not there.
  /// @throws WriteError
  explicit BatchFolder(const std::string& path);

  std::string Full(const std::string& relative) const;
  bool Has(const std::string& relative) const;

  /// The files that converting an entry writes, without a page.
  static std::vector<std::string> OutputsOf(const BatchEntry& entry);

  /// Makes the folder of a file, and removes from it what a killed process left half-written.
  /// @throws WriteError
  void MakeReady(const std::string& relative);

  /// @throws Error where a file is not there.
  std::map<std::string, FileState> Inspect(const std::vector<std::string>& relative) const;

  /// Whether all these files are there, as the record says.
  bool IsComplete(const JournalRecord& record, const std::vector<std::string>& relative) const;

  void Remove(const std::string& relative) const;    ///< where it is there
  void SetAside(const std::string& relative) const;  ///< where it is there: as it + kOutdated

 private:
  std::string path_;
  std::mutex mutex_;
  std::set<std::string> ready_;
};

}  // namespace mmm_converter
