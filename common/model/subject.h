// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "common/model/kinematic_model.h"

namespace mmm_converter {

// What a body has: beyond, a unit, a sign or a label is wrong.
inline constexpr double kLeastSegmentScale = 0.5;
inline constexpr double kLargestSegmentScale = 2;
inline constexpr double kLargestMarkerOffset = 0.5;  ///< of a coordinate [m]

/// How much longer a person's segment is than Winter's proportions have it.
struct SegmentScale {
  std::string segment;            ///< the node whose translation from its parent is scaled
  double scale = 1;               ///< 1: as the model scaled by height
  double standard_deviation = 0;  ///< of scale
  double prior_deviation = 0;     ///< what was assumed before any recording was seen
};

/// Where a person wears a marker.
struct MarkerOffset {
  std::string marker;
  /// From the (scaled) model's place, in axes of the marker's segment [m].
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();
  Eigen::Vector3d standard_deviations = Eigen::Vector3d::Zero();  ///< [m]
  double prior_deviation = 0;                                     ///< of each coordinate [m]
  double skin_deviation = 0;  ///< of each coordinate about the place, over frames [m]; 0: not known
  int frames = 0;             ///< that showed the marker
};

/// A joint whose angle errs with the body that was estimated: by the same in all frames, whatever
/// is tracked with it.
struct JointDoubt {
  std::string joint;
  double deviation = 0;  ///< of that error [rad]
  /// Markers and segments that err with it, as the recordings did not tell them apart; most first.
  std::vector<std::string> partners;
};

/// A recording that a subject was calibrated on.
struct SubjectSource {
  std::string recording;
  int frames = 0;  ///< taken from it
};

/// A person as a tracker needs to know them: Winter's scaling by height and mass, and what was
/// estimated beyond it.
struct Subject {
  std::string name;
  std::string model;                  ///< name of the reference model that all names belong to
  double height = 0;                  ///< [m]
  double mass = 0;                    ///< [kg]
  std::optional<double> hand_length;  ///< [m]
  std::vector<SegmentScale> scales;   ///< segments that are not named keep 1
  std::vector<MarkerOffset> offsets;  ///< markers that are not named keep 0
  std::vector<JointDoubt> joints;     ///< those whose error is worth telling
  std::vector<SubjectSource> sources;
};

/// The share of what was assumed beforehand that the recordings have replaced, 0 to 1:
/// 1 - (deviation / prior)^2. Near 0: the recordings do not determine the quantity.
double Observability(double standard_deviation, double prior_deviation);

/// Of a coordinate: root mean square of the three [m].
double Deviation(const MarkerOffset& offset);

/// The model of the person: `scaled` (by ScaleWinter) with the translation, centre of mass and
/// markers of each named segment times its scale, inertia times its square, and each named marker
/// moved by its offset, of which it gets the deviations. Joints, limits and masses stay as they
/// are.
/// @throws Error naming the segments and markers that the model does not have.
KinematicModel FitToSubject(const KinematicModel& scaled, const Subject& subject);

/// The model with the scales and offsets of a body that landmarks show (FindLandmarkBody); its
/// markers are no more certain for it. @throws Error as FitToSubject.
KinematicModel WithLandmarkBody(const KinematicModel& scaled, const Subject& body);

/// A subject that was calibrated on WithLandmarkBody(scaled, body), relative to `scaled`.
Subject JoinSubjects(const Subject& body, const Subject& calibrated, const KinematicModel& scaled);

}  // namespace mmm_converter
