// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "common/support/warnings.h"

namespace mmm_converter {

struct Scan {
  std::string manifest;  ///< text of a <Batch> file
  int recordings = 0;
  Warnings warnings;
};

/// Looks for recordings in a folder and the folders in it: C3D, TRC, and MMM motions with markers.
/// Each folder becomes a group. An MMM motion beside a C3D or TRC file of the same name is its
/// person's height and mass.
///
/// subjects_file: a CSV table (RFC 4180, empty: none) whose first column "folder" or "file" says
/// which recordings a line is for, relative to the folder scanned; columns height_m, mass_kg and
/// subject_file are of the person, all others become metadata.
/// @throws Error where there is no such folder or no recording in it, and for a malformed table
///         (file and line).
Scan ScanFolder(const std::string& folder, const std::string& subjects_file);

}  // namespace mmm_converter
