// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <string_view>
#include <vector>

// Readers of the formats that are exported. They share no code with the product, follow what
// OpenSim's documentation and its readers say of a format, and take nothing else.
namespace mmm_converter::testing {

struct StrictTrc {
  double rate = 0;
  std::vector<std::string> labels;
  std::vector<long> numbers;              ///< of the frames
  std::vector<double> times;              ///< [s]
  std::vector<Eigen::Matrix3Xd> markers;  ///< by frame: 3 x labels [mm]; not seen: NaN

  Eigen::Vector3d At(std::size_t frame, const std::string& label) const;
};

/// PathFileType 4, the eight keys of line 2 in their order, mm, unique labels without blanks, X1 Y1
/// Z1 ..., a blank line, consecutive frame numbers from OrigDataStartFrame, times that go on by 1 /
/// DataRate, markers whole or empty, a tab behind every cell. @throws std::runtime_error
StrictTrc ReadStrictTrc(std::string_view text);

struct StrictTable {
  std::map<std::string, std::string> keys;  ///< of the header
  std::vector<std::string> columns;
  std::vector<std::vector<double>> rows;  ///< empty cells: NaN

  double At(std::size_t row, const std::string& column) const;
  bool Has(const std::string& column) const;
};

/// version 1; nRows, nColumns and inDegrees as they say; endheader; time first and increasing;
/// unique columns without blanks; finite numbers between tabs. @throws std::runtime_error
StrictTable ReadStrictMot(std::string_view text);

/// Comma-separated, without quotes: unique columns, in each row as many numbers or empty cells.
/// @throws std::runtime_error
StrictTable ReadStrictCsv(std::string_view text);

}  // namespace mmm_converter::testing
