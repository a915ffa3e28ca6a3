// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/io/osim/ik_tasks.h"
#include "common/io/osim/osim_document.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// What OpenSim's scaling (`<ScaleTool>`) is to do. Measurements and factors that are not applied
/// are left out.
struct ScaleSetup {
  struct Measurement {
    std::string name;
    int line = 0;
    std::vector<std::array<std::string, 2>> pairs;  ///< of markers
    /// Bodies that it scales, along these axes (1) and not the others (0).
    std::vector<std::pair<std::string, Eigen::Vector3d>> bodies;
  };
  struct Factors {
    std::string body;
    Eigen::Vector3d factors = Eigen::Vector3d::Ones();
  };
  /// [s]; nothing: the whole recording.
  using TimeRange = std::optional<std::array<double, 2>>;

  std::optional<double> mass;  ///< [kg]
  std::string marker_file;     ///< of a MarkerSet for the model, beside the setup; empty: none
  bool scales = true;
  bool measures_first =
      true;  ///< factors given by hand come after measured ones, over which they go
  std::vector<Measurement> measurements;
  std::vector<Factors> factors;  ///< given by hand
  TimeRange scaling_time;
  bool keeps_mass_distribution = true;
  bool places_markers = true;
  IkTasks tasks;  ///< of the posture at which markers are placed
  TimeRange placing_time;
};

/// Parses a set-up, with the sets that it names in files of their own. Recordings and outputs that
/// it names are not looked at.
/// @throws Error with the file where it is none, numbers are none, or values are to come from a
/// file.
ScaleSetup ParseScaleSetup(std::string_view content, const std::string& file,
                           const OsimPartReader& read_part);

}  // namespace mmm_converter
