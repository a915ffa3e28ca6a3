// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/report/comparison_plot.h"

#include <fmt/format.h>

#include <vector>

#include "common/support/units.h"

namespace mmm_converter {
namespace {

// A text in gnuplot's double quotes; control characters would end it.
std::string Quote(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  }
  return quoted + '"';
}

std::vector<const ComparisonRow*> RowsOf(const Comparison& comparison, int trial) {
  std::vector<const ComparisonRow*> rows;
  for (const ComparisonRow& row : comparison.rows) {
    if (row.trial == trial && row.failure.empty()) rows.push_back(&row);
  }
  return rows;
}

// Time, optimum, then mean and band of each row.
std::string FormatData(const Comparison& comparison, int trial,
                       const std::vector<const ComparisonRow*>& rows) {
  const MarkerSequence& markers = comparison.trials[trial].markers;
  std::string text = fmt::format("$trial{} << end_of_data\n", trial + 1);
  for (int k = 0; k < markers.num_frames(); ++k) {
    text += fmt::format("{:.6g} {:.4f}", markers.time(k),
                        kMillimetres * comparison.grounds[trial].optimum[k]);
    for (const ComparisonRow* row : rows) {
      text += fmt::format(" {:.4f} {:.4f} {:.4f}", kMillimetres * row->mean_distance[k],
                          kMillimetres * row->p05_distance[k], kMillimetres * row->p95_distance[k]);
    }
    text += '\n';
  }
  return text + "end_of_data\n";
}

}  // namespace

std::string FormatComparisonPlot(const Comparison& comparison, const std::string& stem) {
  std::string text =
      "# Draws SVG figures: gnuplot FILE\n"
      "set terminal svg size 1000,420 noenhanced font \"sans-serif,13\" background \"white\"\n"
      "set xlabel \"time [s]\"\nset ylabel \"mean marker distance [mm]\"\n"
      "set yrange [0:*]\nset grid lc rgb \"#dddddd\"\nset key outside right top\n"
      "set style fill transparent solid 0.2 noborder\n";
  for (int t = 0; t < static_cast<int>(comparison.trials.size()); ++t) {
    const std::vector<const ComparisonRow*> rows = RowsOf(comparison, t);
    if (rows.empty()) continue;
    text += FormatData(comparison, t, rows);
    text +=
        fmt::format("set output {}\nset title {}\nplot \\\n",
                    Quote(fmt::format("{}-{}.svg", stem, t + 1)), Quote(comparison.trials[t].name));
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const std::size_t column = 3 + 3 * i;
      const std::string name = Quote(comparison.contenders[rows[i]->contender].name);
      if (comparison.options.runs > 1) {
        text += fmt::format("  $trial{} using 1:{}:{} with filledcurves lt {} notitle, \\\n", t + 1,
                            column + 1, column + 2, i + 1);
      }
      text += fmt::format("  $trial{} using 1:{} with lines lt {} lw 1.5 title {}, \\\n", t + 1,
                          column, i + 1, name);
    }
    text += fmt::format("  $trial{} using 1:2 with lines dt 2 lc rgb \"black\" title \"optimum\"\n",
                        t + 1);
  }
  return text;
}

}  // namespace mmm_converter
