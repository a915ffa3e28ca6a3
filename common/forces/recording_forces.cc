// SPDX-License-Identifier: MIT
#include "common/forces/recording_forces.h"

#include "common/forces/external_loads.h"
#include "common/io/recording/recording_axes.h"

namespace mmm_converter {
namespace {

/// W becomes the frame that R turns it into.
void Turn(const Eigen::Matrix3d& R, RecordedForces* forces) {
  for (PlateForces& one : forces->plates) {
    one.plate.R_WP = R * one.plate.R_WP;
    one.plate.p_WP = R * one.plate.p_WP;
    one.plate.corners = R * one.plate.corners;
    for (Eigen::Matrix3Xd* columns : {&one.force, &one.moment, &one.cop, &one.free_moment}) {
      *columns = R * *columns;
    }
  }
}

}  // namespace

RecordedForces ForcesOf(const Recording& recording, Warnings* warnings) {
  if (recording.format != "C3D") return {};
  RecordedForces forces = ReadForces(recording.file, warnings, ParseUnit(recording.unit).metres);
  const double frame_rate = recording.markers.rate();
  forces.rate = forces.samples_per_frame * frame_rate;
  if (recording.first_frame > 1) {
    forces.first_time = static_cast<double>(recording.first_frame - 1) / frame_rate;
  }
  Turn(RotationToZUp(recording.up_axis), &forces);
  return forces;
}

RecordedForces ForcesOf(const std::string& file, UpAxis up, Warnings* warnings) {
  const Eigen::Matrix3d R = RotationToZUp(up);
  RecordedForces forces = ReadExternalLoads(file, R.row(2).transpose(), warnings);
  Turn(R, &forces);
  return forces;
}

}  // namespace mmm_converter
