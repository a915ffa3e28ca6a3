// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "common/support/warnings.h"

namespace mmm_converter {

/// A muscle's channel.
struct EmgChannel {
  std::string muscle;  ///< the label without its side: "TA" of "L TA"
  std::string side;    ///< "left", "right"; empty: the label tells none
};

/// How active muscles are: their voltage high-passed at 20 Hz (De Luca et al. 2010, "Filtering the
/// surface EMG signal"), rectified, and low-passed at 6 Hz (Hermens et al. 1999, SENIAM).
struct Emg {
  double rate = 0;        ///< of the file's frames [Hz]
  double first_time = 0;  ///< [s]
  std::vector<EmgChannel> channels;
  Eigen::MatrixXd envelopes;  ///< channels x frames [mV]
};

/// Analog channels of a C3D file. labels: separated by commas, as the file has them but for case;
/// "all": those in whose label or description EMG stands. A channel without a unit is in volts.
/// warnings: what is assumed.
/// @throws Error naming the channels that are there where one is not, or is no voltage, or its rate
///         leaves no room for the filters.
Emg ReadEmg(const std::string& file, const std::string& labels, Warnings* warnings);

/// Muscles and sides of labels: "L TA", "R_TA", "Left TA", "TA right", and "LTA" beside "RTA".
std::vector<EmgChannel> EmgChannelsOf(const std::vector<std::string>& labels);

}  // namespace mmm_converter
