// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "common/label/learn/named_places.h"
#include "common/model/kinematic_model.h"
#include "common/model/posture.h"
#include "common/motion/marker_sequence.h"

namespace mmm_converter {

/// What was learnt of a label.
struct LearnedMarker {
  std::string label;
  std::string segment;                             ///< a node of the model; empty: not known
  Eigen::Vector3d p_SM = Eigen::Vector3d::Zero();  ///< axes of the segment, of that size [m]
  double scatter = 0;                              ///< about the place, each coordinate [m]
  double probability = 0;                          ///< of the segment
  std::string left_out;  ///< why the marker is not to be used; empty: it is
};

struct LearnedMarkers {
  std::vector<LearnedMarker> markers;  ///< by label, in the order in which recordings have them
  double mean_distance = 0;            ///< of those that are used from their places [m]
  int frames = 0;                      ///< that they were learnt on
  Posture posture;                     ///< in one of these; tracked joints
  Eigen::Matrix3Xd points;             ///< what that one shows, 3 x labels [m]; NaN: not seen
  std::vector<std::string> warnings;   ///< of names that contradict what is seen
};

/// Who wears the markers.
struct Wearer {
  const KinematicModel& reference;  ///< of 1 m
  /// The reference, its markers or others, of the person's size.
  std::function<KinematicModel(const KinematicModel&)> scale;
  std::vector<int> joints;  ///< tracked
};

/// Learns where a person wears markers: from the places that their names say (FindNamedPlaces),
/// which the body may contradict; of labels that mean nothing by how they move. Points that are
/// computed from others are told apart. Labels are the same thing in all recordings.
/// progress(done, all) may be empty.
/// @throws Error where there are fewer than ten markers, more than a thousand labels, or nobody.
LearnedMarkers LearnMarkers(const Wearer& wearer,
                            const std::vector<const MarkerSequence*>& recordings,
                            const std::function<void(int, int)>& progress);

}  // namespace mmm_converter
