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
  std::vector<int> channels;  ///< FORCE_PLATFORM:CHANNEL, counted from 1; 0: is no channel's number
  /// A column for each corner, in the file's unit and axes; nothing: not stated.
  std::optional<Eigen::Matrix<double, 3, 4>> corners;
  /// In the file's unit and the plate's own axes; nothing: not stated.
  std::optional<Eigen::Vector3d> origin;
  /// FORCE_PLATFORM:CAL_MATRIX: forces [N] and moments [N x file unit] are this times the channels.
  std::optional<Eigen::Matrix<double, 6, 6>> calibration;
  /// FORCE_PLATFORM:FPCOPPOLY: coefficients p1 to p6 of x, then those of y.
  std::optional<Eigen::Matrix<double, 6, 2>> cop_polynomial;
};

/// Frames in which nobody is on the plates, counted from 1, both included.
struct C3dZeroFrames {
  int first = 1, last = 1;
};

/// FORCE_PLATFORM:ZERO. Nothing: not stated, or empty as [0, 0] and [1, 0] are.
std::optional<C3dZeroFrames> ReadC3dZeroFrames(const C3dParameters& parameters);

std::vector<C3dForcePlate> ReadC3dForcePlates(const C3dParameters& parameters, Warnings* warnings);

}  // namespace mmm_converter
