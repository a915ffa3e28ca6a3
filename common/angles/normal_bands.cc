// SPDX-License-Identifier: MIT
#include "common/angles/normal_bands.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <tuple>

#include "common/io/tables/table_text.h"
#include "common/support/error.h"
#include "common/support/text.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

using Cells = std::vector<std::string_view>;

struct BandRow {
  int line = 0;
  double percent = 0, mean = 0, deviation = 0;
};
using RowsOfAngles =
    std::map<std::tuple<std::string, std::string, std::string>, std::vector<BandRow>>;

/// Where the columns are; -1: there is none.
struct Columns {
  int joint = -1, angle = -1, side = -1, unit = -1, percent = -1, mean = -1, deviation = -1;

  bool are_all() const { return std::min({joint, angle, percent, mean, deviation}) >= 0; }
};

Columns FindColumns(const Cells& heads) {
  Columns columns;
  const std::pair<const char*, int*> names[] = {{"joint", &columns.joint},
                                                {"angle", &columns.angle},
                                                {"side", &columns.side},
                                                {"unit", &columns.unit},
                                                {"percent", &columns.percent},
                                                {"mean_degrees", &columns.mean},
                                                {"sd_degrees", &columns.deviation},
                                                {"mean", &columns.mean},
                                                {"sd", &columns.deviation}};
  for (std::size_t i = 0; i < heads.size(); ++i) {
    for (const auto& [name, column] : names) {
      if (EqualIgnoringCase(heads[i], name)) *column = static_cast<int>(i);
    }
  }
  return columns;
}

/// Reads the rows, whatever their order.
class BandReader {
 public:
  BandReader(std::string_view content, const std::string& file) : lines_(content), file_(file) {}

  RowsOfAngles Read(std::string* source) {
    FindHeader(source);
    Cells cells;
    for (std::string_view line; lines_.Next(&line);) {
      if (Trim(line).empty()) continue;
      if (Trim(line).starts_with('#')) {
        Say(line, source);
      } else {
        SplitCells(line, separator_, &cells);
        AddRow(cells);
      }
    }
    return std::move(rows_);
  }

 private:
  [[noreturn]] void Throw(const std::string& what) const {
    throw Error(fmt::format("{}:{}: {}", file_, lines_.number(), what));
  }

  static void Say(std::string_view line, std::string* source) {
    std::string_view text = Trim(Trim(line).substr(1));
    if (StartsWithIgnoringCase(text, "source:")) text = Trim(text.substr(7));
    if (!source->empty() && !text.empty()) *source += ' ';
    *source += ToUtf8(text);
  }

  void FindHeader(std::string* source) {
    Cells heads;
    for (std::string_view line; lines_.Next(&line);) {
      if (Trim(line).empty()) continue;
      if (Trim(line).starts_with('#')) {
        Say(line, source);
        continue;
      }
      separator_ = SeparatorOf(line);
      SplitCells(line, separator_, &heads);
      columns_ = FindColumns(heads);
      if (columns_.are_all()) return;
      break;
    }
    Throw(
        "no bands of normal gait: the header must name joint, angle, percent, mean_degrees and "
        "sd_degrees, as the columns of exported strides");
  }

  std::string_view Cell(const Cells& cells, int column) const {
    if (column < 0) return {};
    if (static_cast<std::size_t>(column) >= cells.size()) {
      Throw(fmt::format("{} cells; the header has more", cells.size()));
    }
    return cells[static_cast<std::size_t>(column)];
  }

  double NumberIn(const Cells& cells, int column, const char* name) const {
    const std::string_view cell = Cell(cells, column);
    const double value = CellNumber(cell, separator_);
    if (!std::isfinite(value)) {
      Throw(fmt::format("{} is \"{}\"; give a number", name, ToUtf8(cell.substr(0, 40))));
    }
    return value;
  }

  void AddRow(const Cells& cells) {
    const auto text = [&](int column) { return ToUtf8(ToLower(Cell(cells, column))); };
    if (columns_.unit >= 0 && text(columns_.unit) != "degrees") return;
    const std::string side = text(columns_.side);
    if (!side.empty() && side != "left" && side != "right") {
      Throw(fmt::format("side is \"{}\"; give left or right, or nothing for both",
                        side.substr(0, 40)));
    }
    BandRow row;
    row.line = lines_.number();
    row.percent = NumberIn(cells, columns_.percent, "percent");
    row.mean = NumberIn(cells, columns_.mean, "mean");
    row.deviation = NumberIn(cells, columns_.deviation, "sd");
    if (row.deviation < 0) Throw("sd is negative");
    rows_[{text(columns_.joint), text(columns_.angle), side}].push_back(row);
  }

  LineReader lines_;
  const std::string& file_;
  char separator_ = ',';
  Columns columns_;
  RowsOfAngles rows_;
};

void CheckReach(const std::vector<BandRow>& rows, const std::string& name,
                const std::string& file) {
  for (std::size_t i = 1; i < rows.size(); ++i) {
    if (rows[i].percent > rows[i - 1].percent) continue;
    throw Error(fmt::format("{}:{}: {} at {:g} % follows {:g} %; percent must grow", file,
                            rows[i].line, name, rows[i].percent, rows[i - 1].percent));
  }
  if (rows.size() > 1 && rows.front().percent == 0 && rows.back().percent == kPercent) return;
  throw Error(fmt::format("{}:{}: {} reaches from {:g} to {:g} %; give it from 0 to 100 %", file,
                          rows.front().line, name, rows.front().percent, rows.back().percent));
}

// Degrees by which hips or knees of no gait stay below, and radians above none.
constexpr double kRadians = 2;

void CheckAreDegrees(const RowsOfAngles& rows, const std::string& file) {
  bool bends = false;
  double most = 0;
  for (const auto& [key, of] : rows) {
    const auto& [joint, motion, side] = key;
    bends |= (joint == "hip" || joint == "knee") && motion == "flexion";
    for (const BandRow& row : of) most = std::max(most, std::abs(row.mean));
  }
  if (!bends || most > kRadians) return;
  throw Error(fmt::format(
      "{}: all angles are within {:g} degrees, of hips and knees, too: are they radians? Give "
      "degrees",
      file, kRadians));
}

NormalBand BandOf(const std::vector<BandRow>& rows) {
  NormalBand band;
  std::size_t next = 1;
  for (int i = 0; i < GaitCycle::kSamples; ++i) {
    const double percent = kPercent * i / (GaitCycle::kSamples - 1);
    while (rows[next].percent < percent) ++next;
    const BandRow& a = rows[next - 1];
    const BandRow& b = rows[next];
    const double share = (percent - a.percent) / (b.percent - a.percent);
    band.mean[i] = a.mean + share * (b.mean - a.mean);
    band.deviation[i] = a.deviation + share * (b.deviation - a.deviation);
  }
  return band;
}

}  // namespace

const NormalBand* NormalBands::Find(std::string_view joint, std::string_view motion,
                                    Side side) const {
  const NormalBand* found = nullptr;
  for (const NormalBand& one : bands) {
    if (one.joint != joint || one.motion != motion) continue;
    if (one.side == side || (!one.side && found == nullptr)) found = &one;
  }
  return found;
}

NormalBands ParseNormalBands(std::string_view content, const std::string& file) {
  NormalBands normal;
  const RowsOfAngles rows = BandReader(content, file).Read(&normal.source);
  if (rows.empty()) throw Error(file + ": no bands of normal gait: no row follows the header");
  if (normal.source.empty()) normal.source = std::filesystem::path(file).filename().string();
  for (const auto& [key, of] : rows) {
    const auto& [joint, motion, side] = key;
    CheckReach(of, joint + ' ' + motion, file);
    NormalBand band = BandOf(of);
    band.joint = joint;
    band.motion = motion;
    if (!side.empty()) band.side = side == "left" ? Side::kLeft : Side::kRight;
    normal.bands.push_back(std::move(band));
  }
  CheckAreDegrees(rows, file);
  return normal;
}

std::vector<std::string> LackingAngles(const NormalBands& normal) {
  std::vector<std::string> lacking;
  for (const auto& [joint, motion] : kProfileAngles) {
    const bool is_there = normal.Find(joint, motion, Side::kLeft) != nullptr &&
                          normal.Find(joint, motion, Side::kRight) != nullptr;
    if (!is_there) lacking.push_back(fmt::format("{} {}", joint, motion));
  }
  return lacking;
}

double OwnSideSign(std::string_view joint, std::string_view motion, Side side) {
  const bool is_middle = joint == "pelvis" || joint == "trunk" || joint == "neck";
  if (!is_middle) return 1;
  if (motion == "obliquity") return side == Side::kLeft ? 1 : -1;  // grows with the left side up
  if (motion == "rotation") return side == Side::kLeft ? -1 : 1;   // grows to the left
  if (motion == "lateral bending") return side == Side::kLeft ? -1 : 1;  // grows to the right
  return 1;
}

double VariableScore(const GaitCycle& stride, const NormalBand& normal) {
  const double stride_sign = OwnSideSign(stride.angle.joint, stride.angle.motion, stride.side);
  double squares = 0;
  for (int i = 0; i < GaitCycle::kSamples; ++i) {
    const double apart = kDegrees * stride_sign * stride.mean[i] - normal.mean[i];
    squares += apart * apart;
  }
  return std::sqrt(squares / GaitCycle::kSamples);
}

}  // namespace mmm_converter
