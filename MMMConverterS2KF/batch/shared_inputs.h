// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <memory>
#include <mutex>
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

  /// Hash of all that the outputs of an entry depend on, except the recording's bytes: this program
  /// with its libraries and marker sets, the plugin, the configuration, the model, the subject, the
  /// attributes.
  /// @throws Error where a file can't be read.
  std::string Fingerprint(const BatchEntry& entry, const ConverterChoice& choice);

 private:
  std::string FileHash(const std::string& path);
  /// With what an MJCF includes.
  std::string RobotHash(const std::string& path);

  std::string program_;  // hash
  std::mutex mutex_;
  std::map<std::string, WithWarnings<std::shared_ptr<const LoadedModel>>> models_;
  std::map<std::string, WithWarnings<std::shared_ptr<const ConverterChoice>>> choices_;
  std::map<std::string, std::string> hashes_, robots_;
};

}  // namespace mmm_converter
