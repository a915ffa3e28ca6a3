// SPDX-License-Identifier: MIT
#include "common/angles/angle_table.h"

#include <fmt/format.h>

#include <string>
#include <vector>

#include "common/io/xml/xml_text.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

constexpr int kDegreeDecimals = 6;

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
    std::vector<std::string> names;
    for (const AnatomicalAngle& one : angles.angles) {
      names.push_back(fmt::format(",{},{},{}", one.joint, one.side, one.motion));
    }
    for (int k = 0; k < angles.num_frames(); ++k) {
      for (std::size_t i = 0; i < names.size(); ++i) {
        const auto row = static_cast<Eigen::Index>(i);
        AppendDecimal(angles.time(k), kSecondDecimals, csv);
        *csv += names[i];
        AppendDegrees(angles.values(row, k), csv);
        if (angles.deviations.size() > 0) {
          AppendDegrees(angles.deviations(row, k), csv);
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
