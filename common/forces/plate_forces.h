// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "common/forces/force_plate.h"
#include "common/support/units.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// Analog samples [begin, end), most often those in which a plate bears somebody.
struct LoadInterval {
  int begin = 0, end = 0;
};

/// What one plate exerts on who stands on it. W: axes of the file. A column for each analog sample;
/// NaN where a channel has no number.
struct PlateForces {
  ForcePlate plate;
  /// As ForcesOfPlate took them: other readings of the plate are made of them. Empty: of a table.
  Eigen::MatrixXd channels;
  Eigen::Matrix3Xd force;        ///< f_W [N], against the person: up under a foot
  Eigen::Matrix3Xd moment;       ///< m_W about p_WP [N m]
  Eigen::Matrix3Xd cop;          ///< centre of pressure p_W, on the surface [m]; NaN: not known
  Eigen::Matrix3Xd free_moment;  ///< along the surface's normal, at the centre of pressure [N m]
  double unloaded_level = 0;     ///< vertical force while nobody is on it [N]
  bool is_seen_unloaded = false;
  bool is_reversed = false;   ///< the file held the forces on the plate, not on the person
  bool tells_contact = true;  ///< false: the sign or the place of its forces can't be told
  double largest_load = 0;    ///< vertical, above the unloaded level [N]
  std::string applied_to;     ///< the body, where a file of forces says it: "calcn_r"
  std::vector<LoadInterval> loads;
  std::vector<LoadInterval> clipped;  ///< a channel stands at the end of its range

  /// Along the surface's normal, up, above the unloaded level [N].
  double Load(int sample) const {
    return -plate.R_WP.col(2).dot(force.col(sample)) - unloaded_level;
  }
};

/// All plates of a recording.
struct RecordedForces {
  double rate = 0;        ///< of samples [Hz]
  double first_time = 0;  ///< of sample 0 [s]
  int samples_per_frame = 1;
  std::vector<PlateForces> plates;

  double time(int sample) const { return first_time + sample / rate; }
};

/// Plates and their forces; W: the file's axes, the first sample at 0 s. Nothing in a file without
/// plates. What files are known to hold wrong - ORIGIN and forces reversed, moments in another
/// unit, offsets - is found from the loaded centre of pressure and told in warnings that name the
/// plate. unit [m]: of its lengths; nothing: as the file says.
/// @throws Error where the file is no C3D file, or has become shorter meanwhile.
RecordedForces ReadForces(const std::string& path, Warnings* warnings,
                          std::optional<double> unit = {});

/// The forces of a plate from its channels, in the order of PlateType: a row for each, a column for
/// each sample. The centre of pressure is told of unloaded samples too, where it means little.
PlateForces ForcesOfPlate(const ForcePlate& plate, const Eigen::MatrixXd& channels);

}  // namespace mmm_converter
