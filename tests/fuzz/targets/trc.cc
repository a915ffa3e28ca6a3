// SPDX-License-Identifier: MIT
#include "common/io/tables/trc_reader.h"
#include "common/io/tables/trc_writer.h"
#include "tests/fuzz/fuzz_target.h"

namespace mmm_converter::testing {

void ReadTrcBytes(std::string_view bytes) {
  LooksLikeTrc(bytes);
  Warnings warnings;
  const MarkerTable read = ParseTrc(bytes, kInputName, &warnings);
  Require(read.markers.num_labels() > 0 && read.markers.num_frames() > 0, "markers and frames");
  TrcOutput output;
  output.first_frame = read.first_frame;
  output.measured = &read.markers;
  const MarkerTable again = ParseTrc(Join(FormatTrc(output)), kInputName);
  Require(again.markers.num_labels() == read.markers.num_labels(), "the labels that were written");
  Require(again.markers.num_frames() == read.markers.num_frames(), "the frames that were written");
}

}  // namespace mmm_converter::testing
