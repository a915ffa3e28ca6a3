// SPDX-License-Identifier: MIT
#include "common/forces/force_plate.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

#include "common/support/text.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

constexpr double kSmallestEdge = 1e-3;      // [m] of a surface
constexpr double kNegligibleOrigin = 2e-3;  // [m]

std::size_t ChannelsOf(PlateType type) { return type == PlateType::kEightForces ? 8 : 6; }

/// Why a plate can't be read; empty: it can.
std::string WhyRefused(const C3dForcePlate& stored, const C3dAnalog& analog) {
  if (stored.type < 1 || stored.type > 4) {
    return stored.type == 0 ? "its type is not stated"
                            : fmt::format("is of type {}; types 1 to 4 are read", stored.type);
  }
  const std::size_t needed = ChannelsOf(static_cast<PlateType>(stored.type));
  if (stored.channels.size() < needed) {
    return fmt::format("type {} has {} channels, {} are stated", stored.type, needed,
                       stored.channels.size());
  }
  for (std::size_t i = 0; i < needed; ++i) {
    const int channel = stored.channels[i];
    if (channel >= 1 && channel <= static_cast<int>(analog.channels.size())) continue;
    return fmt::format("its channel {} is not there: the file has {} analog channels", channel,
                       analog.channels.size());
  }
  if (stored.type == 4 && !stored.calibration) return "is of type 4 and has no CAL_MATRIX";
  if (!stored.corners || !stored.corners->allFinite()) return "its corners are not stated";
  return "";
}

/// ORIGIN leads from the sensors up to the surface: its z is negative in P. Many files hold it the
/// other way round, whole or, of eight forces, its z alone.
void PlaceOrigin(const Eigen::Vector3d& stored, ForcePlate* plate, Warnings* warnings) {
  plate->origin = stored;
  if (plate->type == PlateType::kForcesAndCop) return;
  if (plate->type == PlateType::kEightForces) {
    plate->origin.z() = -std::abs(stored.z());
    plate->has_moments = stored.x() != 0 && stored.y() != 0;
    if (plate->has_moments) return;
    Warn(warnings,
         fmt::format("force plate {}: ORIGIN does not state where its sensors are; forces "
                     "are read, but no centre of pressure",
                     plate->number));
    return;
  }
  const bool has_offset = stored.head<2>().cwiseAbs().maxCoeff() > kNegligibleOrigin;
  if (stored.z() == 0) {
    plate->is_origin_sign_known = !has_offset;
    return;
  }
  if (stored.z() < 0) return;
  plate->origin = -stored;
  if (has_offset) {
    Warn(warnings,
         fmt::format("force plate {}: ORIGIN points down, so it is taken to lead from the surface "
                     "to the sensors and is reversed; x and y of {:.1f} and {:.1f} mm with it",
                     plate->number, 1e3 * stored.x(), 1e3 * stored.y()));
  }
}

std::string LettersOf(const std::string& text) {
  std::string letters;
  for (const char c : ToLower(text)) {
    if (c >= 'a' && c <= 'z') letters += c;
  }
  return letters;
}

/// [N] of the unit of a force's channel; what is no unit of forces is newtons.
double ForceUnit(const std::string& text) {
  const std::string letters = LettersOf(text);
  if (letters == "kn" || letters.starts_with("kilonewton")) return 1e3;
  if (letters == "lbf" || letters == "lbs" || letters == "lb") return 4.4482216;
  return 1;
}

/// [N m] of the unit of a moment's channel. No unit of moments: newtons times the file's unit.
double MomentUnit(const std::string& text, double file_unit) {
  std::string letters = LettersOf(text);
  const double newtons = letters.starts_with("kn") ? 1e3 : 1;
  if (newtons > 1) letters.erase(0, 1);
  if (!letters.starts_with('n')) return file_unit;
  if (letters.ends_with("mm")) return newtons * 1e-3;
  if (letters.ends_with("cm")) return newtons * 1e-2;
  const bool is_in_metres = letters.ends_with("m") || letters.ends_with("meter") ||
                            letters.ends_with("meters") || letters.ends_with("metre");
  return is_in_metres && letters.size() > 1 ? newtons : file_unit;
}

constexpr double kNoPlate = 0.1;         // [m] an edge of a plate is longer
constexpr double kLargestPlate = 20;     // [m] a belt is shorter
constexpr double kUsualPlate = 0.5;      // [m]
constexpr double kFarthestSensor = 0.3;  // [m] below the surface

/// Corners are sometimes in another unit than points: the one that makes them a plate's.
void CorrectCornerUnit(Eigen::Vector3d* origin, ForcePlate* plate, Warnings* warnings) {
  const auto edge = [&] { return (plate->corners.col(0) - plate->corners.col(1)).norm(); };
  const double stated = edge();
  const auto is_plate = [](double size) { return size >= kNoPlate && size <= kLargestPlate; };
  if (!(stated > 0) || is_plate(stated)) return;
  double best = 1;
  const auto apart = [&](double scale) { return std::abs(std::log(scale * stated / kUsualPlate)); };
  for (const double scale : {1e3, 1e-3, 1e2, 1e-2, 10.0, 0.1, 25.4, 1 / 25.4}) {
    if (apart(scale) < apart(best)) best = scale;
  }
  if (!is_plate(best * stated)) return;
  Warn(warnings, fmt::format("force plate {}: its corners are {:.3g} mm apart in the unit of the "
                             "points; taken to be in another one, which makes that {:.3g} m",
                             plate->number, kMillimetres * stated, best * stated));
  plate->corners *= best;
  if (best * origin->norm() <= kFarthestSensor) *origin *= best;
}

}  // namespace

// The frame of the surface: x from the mean of two edges, z from them and the other two.
bool PlaceBetweenCorners(ForcePlate* plate) {
  const auto& c = plate->corners;
  const Eigen::Vector3d x = (c.col(0) - c.col(1) + c.col(3) - c.col(2)) / 2;
  const Eigen::Vector3d along = (c.col(0) - c.col(3) + c.col(1) - c.col(2)) / 2;
  const Eigen::Vector3d z = x.cross(along);
  plate->half_size = {x.norm() / 2, along.norm() / 2};
  if (plate->half_size.minCoeff() < kSmallestEdge || z.norm() < kSmallestEdge * kSmallestEdge) {
    return false;
  }
  plate->R_WP.col(0) = x.normalized();
  plate->R_WP.col(2) = z.normalized();
  plate->R_WP.col(1) = plate->R_WP.col(2).cross(plate->R_WP.col(0));
  plate->p_WP = c.rowwise().mean();
  return true;
}

std::vector<ForcePlate> ReadForcePlates(const C3dFile& file, const C3dAnalog& analog, double unit,
                                        Warnings* warnings) {
  std::vector<ForcePlate> plates;
  int number = 0;
  for (const C3dForcePlate& stored : ReadC3dForcePlates(file.parameters(), warnings)) {
    ++number;
    std::string refused = WhyRefused(stored, analog);
    ForcePlate plate;
    plate.number = number;
    Eigen::Vector3d origin = unit * stored.origin.value_or(Eigen::Vector3d::Zero());
    if (!origin.allFinite()) origin.setZero();
    if (refused.empty()) {
      plate.type = static_cast<PlateType>(stored.type);
      plate.corners = unit * *stored.corners;
      CorrectCornerUnit(&origin, &plate, warnings);
      if (!PlaceBetweenCorners(&plate)) refused = "its corners do not span a surface";
    }
    if (!refused.empty()) {
      WarnOfKind(warnings, "force plates that can't be read",
                 fmt::format("force plate {} is left out: {}", number, refused));
      continue;
    }
    for (std::size_t i = 0; i < ChannelsOf(plate.type); ++i) {
      plate.channels.push_back(stored.channels[i] - 1);
    }
    plate.file_unit = unit;
    plate.moment_unit = unit;
    const auto unit_of = [&](int channel) -> const std::string& {
      return analog.channels[static_cast<std::size_t>(channel)].unit;
    };
    if (plate.type != PlateType::kCalibratedChannels) {
      const std::size_t vertical = plate.type == PlateType::kEightForces ? 4 : 2;
      plate.force_unit = ForceUnit(unit_of(plate.channels[vertical]));
    }
    if (plate.type == PlateType::kForcesAndMoments || plate.type == PlateType::kForcesAndCop) {
      plate.moment_unit = MomentUnit(unit_of(plate.channels.back()), unit);  // of Mz or Tz
    }
    plate.calibration = stored.calibration;
    if (plate.type == PlateType::kEightForces) plate.cop_polynomial = stored.cop_polynomial;
    PlaceOrigin(origin, &plate, warnings);
    plates.push_back(std::move(plate));
  }
  return plates;
}

}  // namespace mmm_converter
