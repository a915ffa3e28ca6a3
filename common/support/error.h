// SPDX-License-Identifier: MIT
#pragma once

#include <stdexcept>
#include <string>

namespace mmm_converter {

/// What a user can give or do where an Error says that it is missing. How that is done in a program
/// (its option, its field) is the program's to say.
enum class Remedy {
  kNone,
  kHeight,           ///< the person's height
  kMass,             ///< the person's mass
  kRate,             ///< the recording's frame rate
  kFrames,           ///< a part of the recording
  kSubjectPrefix,    ///< one of several subjects
  kMotion,           ///< one of several motions
  kMarkerSet,        ///< which labels stand for which markers
  kModel,            ///< another model
  kIgnoreResiduals,  ///< points that a C3D file marks as invalid
  kLabels,           ///< names for points that have none
  kUnit,             ///< the unit of the file's coordinates
  kUpAxis,           ///< the file's axis that points up
};

/// Bad input. The message is complete for a user: where it is (file and line or byte), what was
/// found, what was expected, what to do. Only `main` catches and prints it.
class Error : public std::runtime_error {
 public:
  explicit Error(const std::string& message, Remedy remedy = Remedy::kNone);
  ~Error() override;

  Remedy remedy() const { return remedy_; }

 private:
  Remedy remedy_;
};

/// A file can't be written.
class WriteError : public Error {
 public:
  /// error_number: errno
  WriteError(const std::string& path, int error_number);
  /// Whether other files of the same disk can't be written either: it is full, over a quota, broken
  /// or gone.
  bool concerns_disk() const;

 private:
  int error_number_;
};

}  // namespace mmm_converter
