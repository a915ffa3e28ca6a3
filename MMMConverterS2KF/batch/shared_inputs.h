// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>

#include "MMMConverterS2KF/batch/manifest.h"

namespace mmm_converter {

/// What the recordings of a batch share, read once: models, configurations with their plugins, and
/// hashes of the files that outputs depend on. For several threads.
class SharedInputs {
 public:
  SharedInputs();

  /// The model and the converter of an entry's request.
  /// @throws Error where one of them can't be read.
  ReadBefore ReadFor(const ConversionRequest& request);

  /// Hash of what the outputs of an entry depend on before its recording is read: this program with
  /// its libraries and data, the attributes, and FilesOf.
  /// @throws Error where a file can't be read.
  std::string Fingerprint(const BatchEntry& entry, const ReadBefore& read_before);

  /// The files of model, converter and robot with all that they name, and those that the request
  /// names, except the recording; absolute, links resolved.
  std::set<std::string> FilesOf(const BatchEntry& entry, const ReadBefore& read_before);

 private:
  std::string FileHash(const std::string& path);
  /// With what it includes.
  std::set<std::string> FilesOfRobot(const std::string& path);

  std::string program_;  // hash
  std::mutex mutex_;
  template <typename T>
  struct Shared {
    WithWarnings<std::shared_ptr<const T>> value;
    std::set<std::string> opened;  // files that it was read of
  };
  std::map<std::string, Shared<LoadedModel>> models_;
  std::map<std::string, Shared<ConverterChoice>> choices_;
  std::map<std::string, std::string> hashes_;
  std::map<std::string, std::set<std::string>> robots_;
};

}  // namespace mmm_converter
