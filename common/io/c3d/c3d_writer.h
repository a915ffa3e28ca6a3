// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "common/motion/marker_sequence.h"

namespace mmm_converter {

struct C3dWriteOptions {
  long first_frame = 1;      ///< number of the first frame in the capture, from 1
  std::string comment = {};  ///< MANUFACTURER:COMMENT, at most 255 characters; empty: none
};

/// Writes a C3D file: Intel floats, mm, z up; an unseen marker is (0,0,0), marked invalid. Labels
/// beyond 255 continue in LABELS2, LABELS3, ...; more than 65535 frames are counted in LONG_FRAMES
/// and TRIAL. The file appears whole or not at all.
/// @throws Error where the format can't hold it (no marker or more than 65535, a label of more than
/// 127
///         characters, no frame), or the file can't be written.
void WriteC3d(const std::string& path, const MarkerSequence& markers,
              const C3dWriteOptions& options = {});

}  // namespace mmm_converter
