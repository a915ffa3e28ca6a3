// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/angles/gait.h"

namespace mmm_converter {

/// Of an angle, or of a moment, over the gait cycle; angles in degrees, as they are compared.
struct NormalBand {
  std::string joint, motion;
  std::optional<Side> side;  ///< nothing: of both
  std::array<double, GaitCycle::kSamples> mean = {}, deviation = {};
};

/// What others are compared with, as healthy gait.
struct NormalBands {
  std::string source;  ///< whose they are, as the file says it; else the file's name
  std::vector<NormalBand> bands;

  /// Null: there is none. The one of the side before that of both.
  const NormalBand* Find(std::string_view joint, std::string_view motion, Side side) const;
};

inline constexpr std::size_t kMostNormalBytes = std::size_t{16} << 20;

/// A CSV whose header names joint, angle, percent, mean_degrees and sd_degrees (or mean and sd), in
/// any order, and perhaps side, and unit, of which degrees alone count: what --export-gait writes
/// of others is such a file. Percent grow from 0 to 100 in each angle; between them it is linear.
/// Lines that begin with # say the source.
/// @throws Error with all that is wrong; also where hips and knees bend as little as radians say.
NormalBands ParseNormalBands(std::string_view content, const std::string& file);

/// +1 where an angle means the same for both sides of the body, and where it is the side's own;
/// -1: an angle of the middle grows to the other side. Pelvis and trunk then rise and bend, and
/// turn forward, with their own side.
double OwnSideSign(std::string_view joint, std::string_view motion, Side side);

/// One of the nine angles of the Movement Analysis Profile (Baker et al. 2009, Gait & Posture 30).
struct ProfileAngle {
  const char* joint;
  const char* motion;
};
inline constexpr std::array<ProfileAngle, 9> kProfileAngles = {{{"pelvis", "tilt"},
                                                                {"hip", "flexion"},
                                                                {"knee", "flexion"},
                                                                {"ankle", "dorsiflexion"},
                                                                {"pelvis", "obliquity"},
                                                                {"hip", "adduction"},
                                                                {"pelvis", "rotation"},
                                                                {"hip", "internal rotation"},
                                                                {"foot", "progression"}}};

/// Of these, those that the bands lack, without which there is no score: "pelvis tilt".
std::vector<std::string> LackingAngles(const NormalBands& normal);

/// Root mean square over the cycle of what a stride's angle [rad] differs from the normal mean,
/// each with its own side's sign [degrees]: a Gait Variable Score. NaN: some of it is not known.
double VariableScore(const GaitCycle& stride, const NormalBand& normal);

}  // namespace mmm_converter
