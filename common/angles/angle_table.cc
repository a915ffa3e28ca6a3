// SPDX-License-Identifier: MIT
#include "common/angles/angle_table.h"

#include <fmt/format.h>

#include <string>
#include <vector>

#include "common/angles/normal_bands.h"
#include "common/io/xml/xml_text.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

constexpr int kDegreeDecimals = 6;

struct Column {
  std::string name;
  Eigen::Index row = 0;
  double sign = 1;
};

/// Turns of the middle of the body to one side stand there as each side sees them, too.
std::vector<Column> ColumnsOf(const AnatomicalAngles& angles) {
  std::vector<Column> columns;
  for (std::size_t i = 0; i < angles.angles.size(); ++i) {
    const AnatomicalAngle& one = angles.angles[i];
    const auto add = [&](const char* side, double sign) {
      columns.push_back({fmt::format(",{},{},{}", one.joint, side, one.motion),
                         static_cast<Eigen::Index>(i), sign});
    };
    add(one.side, 1);
    const double left = OwnSideSign(one.joint, one.motion, Side::kLeft);
    const double right = OwnSideSign(one.joint, one.motion, Side::kRight);
    if (left == right) continue;
    add("left", left);
    add("right", right);
  }
  return columns;
}

void AppendDegrees(double angle, std::string* out) {
  *out += ',';
  AppendDecimal(kDegrees * angle, kDegreeDecimals, out);
}

}  // namespace

TextPieces FormatAngleCsv(const AnatomicalAngles& angles) {
  return [&angles](const TextSink& sink) {
    PieceWriter pieces(sink);
    std::string* const csv = pieces.text();
    *csv += "time_s,joint,side,angle,degrees,sd_degrees\n";
    const std::vector<Column> columns = ColumnsOf(angles);
    for (int k = 0; k < angles.num_frames(); ++k) {
      for (const Column& column : columns) {
        AppendDecimal(angles.time(k), kSecondDecimals, csv);
        *csv += column.name;
        AppendDegrees(column.sign * angles.values(column.row, k), csv);
        if (angles.deviations.size() > 0) {
          AppendDegrees(angles.deviations(column.row, k), csv);
        } else {
          *csv += ',';
        }
        *csv += '\n';
      }
      pieces.EndPart();
    }
    pieces.Flush();
  };
}

}  // namespace mmm_converter
