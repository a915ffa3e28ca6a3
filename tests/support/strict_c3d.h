// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace mmm_converter::testing {

/// A C3D file as a strict reader has it, which shares no code with the product and follows the
/// guide of c3d.org: every record where the one before says, texts of one width, header and POINT
/// parameters agreeing on points and data. Bytes are as they are stored.
struct StrictC3d {
  std::string header;                          ///< 512 bytes
  std::vector<std::string> order;              ///< "POINT:USED", groups as "POINT", by record
  std::map<std::string, std::string> records;  ///< by that name: all bytes behind the offset
  std::vector<std::string> labels;             ///< of points, without padding; LABELS, LABELS2, ...
  std::vector<std::string> descriptions;
  int points = 0, frames = 0, data_block = 0;
  std::vector<std::vector<std::string>> words;  ///< by frame, then by point: 8 or 16 bytes
  std::vector<std::string> analog;              ///< by frame
  std::string behind;                           ///< what follows the last frame

  int Find(const std::string& label) const;  ///< -1: none
};

/// @throws std::runtime_error
StrictC3d ReadStrictC3d(std::string_view file);

}  // namespace mmm_converter::testing
