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

RecordedForces ReadTurned(const std::string& file, UpAxis up, Warnings* warnings) {
  const Eigen::Matrix3d R = RotationToZUp(up);
  RecordedForces forces = ReadExternalLoads(file, R.row(2).transpose(), warnings);
  Turn(R, &forces);
  return forces;
}

constexpr double kLeastUpright = 0.7;

/// The upward part of the forces over their sizes: some 0.95 for persons on level plates, -1 to 1.
double Uprightness(const RecordedForces& forces) {
  double upward = 0, size = 0;
  for (const PlateForces& one : forces.plates) {
    for (Eigen::Index i = 0; i < one.force.cols(); ++i) {
      if (!one.force.col(i).allFinite()) continue;
      upward += one.force(2, i);
      size += one.force.col(i).norm();
    }
  }
  return size > 0 ? upward / size : 1;
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
  Warnings as_given, as_other;
  RecordedForces forces = ReadTurned(file, up, &as_given);
  bool is_other = false;
  if (up != UpAxis::kY && Uprightness(forces) < kLeastUpright) {
    RecordedForces other = ReadTurned(file, UpAxis::kY, &as_other);
    is_other = Uprightness(other) >= kLeastUpright;
    if (is_other) forces = std::move(other);
  }
  if (warnings == nullptr) return forces;
  if (is_other) {
    warnings->Add(file + ": its forces point along y, which is taken as up, as in OpenSim's files");
  }
  warnings->Append(is_other ? as_other : as_given);
  return forces;
}

}  // namespace mmm_converter
