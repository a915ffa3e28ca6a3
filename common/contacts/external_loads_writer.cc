// SPDX-License-Identifier: MIT
#include "common/contacts/external_loads_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/io/tables/column_names.h"
#include "common/io/tables/table_rows.h"
#include "common/io/xml/xml_text.h"
#include "common/math/up_axis.h"
#include "common/support/error.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

constexpr int kForceDecimals = 6;

/// A plate, and who bears it at which of its loads.
struct PlateAndBearer {
  const PlateForces* plate = nullptr;
  Bearer bearer = Bearer::kUnknown;
  bool is_part_of_foot = false;
  std::vector<LoadInterval> loads;

  bool IsOf(const PlateForces* other, const PlateLoad& load) const {
    return plate == other && bearer == load.bearer && is_part_of_foot == load.is_part_of_foot;
  }
};

bool HasCentreOfPressure(const PlateForces& plate) {
  return plate.plate.has_moments &&
         std::any_of(plate.loads.begin(), plate.loads.end(), [&](auto l) {
           for (int k = l.begin; k < l.end; ++k) {
             if (plate.cop.col(k).allFinite()) return true;
           }
           return false;
         });
}

std::vector<PlateAndBearer> PairsOf(const ExternalLoads& loads) {
  std::vector<PlateAndBearer> pairs;
  for (const PlateLoad& load : loads.contacts->loads) {
    const PlateForces* plate = &loads.forces->plates[load.plate];
    if (!HasCentreOfPressure(*plate)) continue;
    const auto same = std::find_if(pairs.begin(), pairs.end(), [&](const PlateAndBearer& one) {
      return one.IsOf(plate, load);
    });
    if (same == pairs.end()) {
      pairs.push_back({plate, load.bearer, load.is_part_of_foot, {load.samples}});
    } else {
      same->loads.push_back(load.samples);
    }
  }
  return pairs;
}

bool IsLoaded(const PlateAndBearer& pair, int sample) {
  return std::any_of(pair.loads.begin(), pair.loads.end(), [&](const LoadInterval& load) {
    return load.begin <= sample && sample < load.end;
  });
}

/// Where the pressure is told first.
Eigen::Vector3d FirstCentre(const PlateAndBearer& pair) {
  for (const LoadInterval& load : pair.loads) {
    for (int k = load.begin; k < load.end; ++k) {
      if (pair.plate->cop.col(k).allFinite()) return pair.plate->cop.col(k);
    }
  }
  return pair.plate->plate.p_WP;
}

void CheckHasForce(const PlateAndBearer& pair, int sample, double time) {
  if (pair.plate->force.col(sample).allFinite()) return;
  throw Error(
      fmt::format("force plate {}: its force at {:.4f} s is no number, which OpenSim can't "
                  "use; choose frames without",
                  pair.plate->plate.number, time));
}

/// The rows of one table.
class RowWriter {
 public:
  RowWriter(const ExternalLoads& loads, std::vector<PlateAndBearer> pairs)
      : forces_(*loads.forces), pairs_(std::move(pairs)) {
    for (const PlateAndBearer& pair : pairs_) held_.push_back(FirstCentre(pair));
  }

  void operator()(int sample, std::string* out) {
    AppendDecimal(forces_.time(sample), kSecondDecimals, out);
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      const PlateForces& plate = *pairs_[i].plate;
      Eigen::Vector3d force = Eigen::Vector3d::Zero();
      Eigen::Vector3d moment = Eigen::Vector3d::Zero();
      if (IsLoaded(pairs_[i], sample)) {
        CheckHasForce(pairs_[i], sample, forces_.time(sample));
        force = plate.force.col(sample);
        if (plate.cop.col(sample).allFinite()) held_[i] = plate.cop.col(sample);
        if (plate.free_moment.col(sample).allFinite()) moment = plate.free_moment.col(sample);
      }
      for (const Eigen::Vector3d& one : {force, held_[i], moment}) AppendVector(one, out);
    }
  }

 private:
  static void AppendVector(const Eigen::Vector3d& v, std::string* out) {
    static const Eigen::Matrix3d rotation = RotationToZUp(UpAxis::kY).transpose();
    AppendCells(Eigen::Vector3d(rotation * v), '\t', kForceDecimals, "", out);
  }

  const RecordedForces& forces_;
  std::vector<PlateAndBearer> pairs_;
  std::vector<Eigen::Vector3d> held_;  // centres of pressure
};

}  // namespace

TextPieces FormatExternalLoadsTable(const ExternalLoads& loads, const std::string& file_name) {
  const RecordedForces& forces = *loads.forces;
  const std::vector<PlateAndBearer> pairs = PairsOf(loads);
  const int samples = forces.plates.empty() ? 0 : static_cast<int>(forces.plates[0].force.cols());
  const auto sample = [&](double time) {
    return std::clamp((time - forces.first_time) * forces.rate, 0.0, std::max(samples - 1.0, 0.0));
  };
  // A row at a moment that rounding moves beyond an end is within.
  const int first = static_cast<int>(std::ceil(sample(loads.begin) - 1e-6));
  const int last = static_cast<int>(std::floor(sample(loads.end) + 1e-6));
  std::string header =
      fmt::format("{}\nversion=1\nnRows={}\nnColumns={}\ninDegrees=no\nendheader\ntime",
                  OneWord(file_name), last - first + 1, 1 + 9 * pairs.size());
  for (std::size_t i = 1; i <= pairs.size(); ++i) {
    header += fmt::format(
        "\tground_force_{0}_vx\tground_force_{0}_vy\tground_force_{0}_vz\tground_force_{0}_px"
        "\tground_force_{0}_py\tground_force_{0}_pz\tground_torque_{0}_x\tground_torque_{0}_y"
        "\tground_torque_{0}_z",
        i);
  }
  return TableText(header + '\n', {first, last + 1}, RowWriter(loads, pairs));
}

std::string FormatExternalLoadsXml(const ExternalLoads& loads, const std::string& table) {
  std::string text = kExternalLoadsBegin;
  const std::vector<PlateAndBearer> pairs = PairsOf(loads);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const Bearer bearer = pairs[i].bearer;
    const bool is_part = pairs[i].is_part_of_foot;
    const bool is_one_foot = (bearer == Bearer::kLeft || bearer == Bearer::kRight) && !is_part;
    text += fmt::format(
        "      <ExternalForce name=\"plate_{}_{}{}\">\n"
        "        <appliesForce>{}</appliesForce>\n"
        "        <applied_to_body>{}</applied_to_body>\n"
        "        <force_expressed_in_body>ground</force_expressed_in_body>\n"
        "        <point_expressed_in_body>ground</point_expressed_in_body>\n"
        "        <force_identifier>ground_force_{}_v</force_identifier>\n"
        "        <point_identifier>ground_force_{}_p</point_identifier>\n"
        "        <torque_identifier>ground_torque_{}_</torque_identifier>\n"
        "        <data_source_name>{}</data_source_name>\n"
        "      </ExternalForce>\n",
        pairs[i].plate->plate.number, Name(bearer), is_part ? "_part" : "", is_one_foot,
        bearer == Bearer::kLeft ? "calcn_l" : "calcn_r", i + 1, i + 1, i + 1, EscapeXml(table));
  }
  return text + fmt::format(
                    "    </objects>\n    <groups/>\n    <datafile>{}</datafile>\n"
                    "  </ExternalLoads>\n</OpenSimDocument>\n",
                    EscapeXml(table));
}

}  // namespace mmm_converter
