// SPDX-License-Identifier: MIT
#include "common/io/tables/motive_csv.h"
#include "common/io/tables/nexus_csv.h"
#include "common/io/tables/points_csv.h"
#include "common/io/tables/qtm_tsv.h"
#include "common/io/tables/trc_reader.h"
#include "common/io/tables/trc_writer.h"
#include "tests/fuzz/fuzz_target.h"

namespace mmm_converter::testing {
namespace {

/// What was read is the same when it is written as TRC and read again.
void CheckTable(const MarkerTable& read) {
  Require(read.markers.num_labels() > 0 && read.markers.num_frames() > 0, "markers and frames");
  Require(read.num_rows > 0 && read.num_rows <= read.markers.num_frames(), "a frame for each row");
  TrcOutput output;
  output.first_frame = read.first_frame;
  output.measured = &read.markers;
  const MarkerTable again = ParseTrc(Join(FormatTrc(output)), kInputName);
  Require(again.markers.num_labels() == read.markers.num_labels(), "the labels that were written");
  Require(again.markers.num_frames() == read.markers.num_frames(), "the frames that were written");
}

}  // namespace

void ReadNexusCsvBytes(std::string_view bytes) {
  LooksLikeNexusCsv(bytes);
  CheckTable(ParseNexusCsv(bytes, kInputName));
}

void ReadMotiveCsvBytes(std::string_view bytes) {
  LooksLikeMotiveCsv(bytes);
  CheckTable(ParseMotiveCsv(bytes, kInputName));
}

void ReadPointsCsvBytes(std::string_view bytes) {
  LooksLikePointsCsv(bytes);
  CheckTable(ParsePointsCsv(bytes, kInputName));
}

void ReadQtmTsvBytes(std::string_view bytes) {
  LooksLikeQtmTsv(bytes);
  CheckTable(ParseQtmTsv(bytes, kInputName));
}

}  // namespace mmm_converter::testing
