// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "common/io/tables/table_text.h"
#include "common/motion/marker_sequence.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// The markers of a table with a row for each frame, as it stands.
struct MarkerTable {
  MarkerSequence markers;  ///< file units and axes; not seen, or in frames that are missing: NaN
  bool has_rate = true;    ///< false: neither a number nor an even time column gives one
  std::string unit;        ///< empty: the file does not say
  long first_frame = 1;
  long num_rows = 0;
  long declared_frames = 0;  ///< that the file says it holds; 0: it does not say
};

/// Which cells of a row are what.
class MarkerColumns {
 public:
  std::vector<std::string> labels;
  std::vector<std::size_t> first;  ///< of each label: x; y and z follow
  int frame = 0;                   ///< -1: there is none
  int time = 1;                    ///< -1: there is none

  /// A label that is there already gets its number: "*C7#4".
  void Add(std::string_view label, std::size_t first_cell);

 private:
  std::set<std::string> seen_;
};

struct MarkerRowsFormat {
  const char* name = "";  ///< of the file, for messages: "TRC file"
  char separator = '\t';  ///< ' ': rows of another length than a whole one have no marker
  bool ends_with_other_row = false;  ///< a row without a frame number ends the table; else it is
                                     ///< passed over
  double said_rate = 0;              ///< [Hz]; NaN or 0: the file does not say
};

/// The rows that follow. A marker at the origin, further than 1e6 away or with a cell that is no
/// number is not seen.
/// @throws Error where there is no row, or a place in time for far more frames than rows.
MarkerTable ReadMarkerRows(LineReader* lines, const MarkerColumns& columns,
                           const MarkerRowsFormat& format, const std::string& file,
                           std::size_t file_bytes, Warnings* warnings);

}  // namespace mmm_converter
