// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/support/warnings.h"

namespace mmm_converter {

/// What the rows of a table say of when they were measured.
struct RowTimes {
  std::vector<double> frames;  ///< the number of each row's frame; NaN: not stated
  std::vector<double> times;   ///< [s] of each row; NaN: not stated
  double resolution = 0;       ///< [s] a unit of the last decimal of the times
};

/// Where rows are on an even time grid; what is missing between them is a gap in it.
struct RowPlaces {
  double rate = 0;                   ///< [Hz]; 0: neither stated nor told by the times
  double first_time = 0;             ///< [s] of place 0
  long first_frame = 1;              ///< number of the frame at place 0
  std::vector<std::int64_t> places;  ///< of each row, from 0; -1: the row repeats the one before it
  std::int64_t num_places = 0;       ///< at most 1e15
};

/// Time counts, and the frames' number where rows have none, or one too coarse to tell. A time that
/// does not fit between its neighbours, which do fit each other, is passed over. Where time stands
/// or goes back, rows follow each other. Frames that are missing and all that contradicts itself
/// are named in warnings. said_rate [Hz]: what the file says, NaN or 0 where it doesn't; the times
/// overrule it.
RowPlaces PlaceRows(RowTimes rows, double said_rate, Warnings* warnings);

}  // namespace mmm_converter
