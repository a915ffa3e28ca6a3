// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "common/io/c3d/c3d_file.h"
#include "common/support/warnings.h"

namespace mmm_converter {

struct C3dAnalogChannel {
  std::string label;        ///< `*` and its number where the file says nothing
  std::string unit;         ///< as it stands; may be empty
  std::string description;  ///< may be empty
};

/// What is sampled beside the points.
struct C3dAnalog {
  std::vector<C3dAnalogChannel> channels;
  double rate = 0;            ///< [Hz]; 0: not known
  int samples_per_frame = 0;  ///< of each channel
};

C3dAnalog ReadC3dAnalog(const C3dFile& file, Warnings* warnings);

/// All samples in their channels' units, (stored - OFFSET) * SCALE * GEN_SCALE: a row for each
/// channel of `analog`, which is the file's; a column for each moment, 1 / rate apart from the
/// first frame on. Reads the whole file.
/// @throws Error where it has become shorter meanwhile.
Eigen::MatrixXd ReadC3dAnalogSamples(C3dFile* file, const C3dAnalog& analog);

struct C3dForcePlate {
  int type = 0;               ///< FORCE_PLATFORM:TYPE; 0: not stated
  std::vector<int> channels;  ///< counted from 1, as FORCE_PLATFORM:CHANNEL has them
  /// A column for each corner, in the file's unit and axes; nothing: not stated.
  std::optional<Eigen::Matrix<double, 3, 4>> corners;
  /// In the file's unit and the plate's own axes; nothing: not stated.
  std::optional<Eigen::Vector3d> origin;
};

std::vector<C3dForcePlate> ReadC3dForcePlates(const C3dParameters& parameters, Warnings* warnings);

}  // namespace mmm_converter
