// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <string>
#include <utility>

#include "common/io/xml/xml_text.h"
#include "common/support/text_pieces.h"

namespace mmm_converter {

/// Rows [begin, end) of a table.
struct TableRows {
  int begin = 0, end = 0;
  int count() const { return end - begin; }
};

/// From the first to the last column that has a value: programs take no table that begins with
/// unknown rows. None has: all of them.
inline TableRows RowsWithValues(const Eigen::MatrixXd& values) {
  TableRows known = {0, static_cast<int>(values.cols())};
  const auto is_known = [&](int k) { return values.col(k).array().isFinite().any(); };
  while (known.begin < known.end && !is_known(known.begin)) ++known.begin;
  if (known.count() == 0) return {0, static_cast<int>(values.cols())};
  while (!is_known(known.end - 1)) --known.end;
  return known;
}

/// A table: row(k, out) appends what row k has before its line's end, one row after the other. What
/// a row keeps for the next one begins anew with each text.
template <typename Row>
TextPieces TableText(std::string header, TableRows rows, Row row) {
  return [header = std::move(header), rows, row = std::move(row)](const TextSink& sink) {
    PieceWriter pieces(sink);
    *pieces.text() += header;
    Row append = row;  // NOLINT(performance-unnecessary-copy-initialization): it may keep things
    for (int k = rows.begin; k < rows.end; ++k) {
      append(k, pieces.text());
      *pieces.text() += '\n';
      pieces.EndPart();
    }
    pieces.Flush();
  };
}

/// Appends a cell for each of the values, behind `before`; unknown: what stands for one that is not
/// finite.
template <typename Values>
void AppendCells(const Values& values, char before, int decimals, const char* unknown,
                 std::string* out) {
  for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(values.size()); ++i) {
    const double value = values[i];
    *out += before;
    if (std::isfinite(value)) {
      AppendDecimal(value, decimals, out);
    } else {
      *out += unknown;
    }
  }
}

/// The same of tables that commas separate, where nothing stands for such a value.
template <typename Values>
void AppendCsvCells(const Values& values, int decimals, std::string* out) {
  AppendCells(values, ',', decimals, "", out);
}

}  // namespace mmm_converter
