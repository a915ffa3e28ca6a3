// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "common/label/learn/body_sites.h"
#include "common/motion/marker_sequence.h"

namespace mmm_converter {

/// Where the name of a label says that it is worn.
struct NamedPlace {
  int site = -1;                                   ///< -1: the name tells nothing that is believed
  bool is_at_place = false;                        ///< else somewhere on the site, as clusters are
  Eigen::Vector3d p_SM = Eigen::Vector3d::Zero();  ///< axes of the site [m]
  double deviation = 0;                            ///< of markers from there, on each axis [m]
};

struct NamedPlaces {
  std::vector<NamedPlace> labels;     ///< in the order of the labels
  std::vector<std::string> warnings;  ///< of names that the body contradicts
};

struct NamedBody {
  const KinematicModel& reference;  ///< of 1 m
  const BodySites& sites;           ///< of the person
  /// The reference, with some more markers, of the person's size.
  std::function<KinematicModel(const KinematicModel&)> scale;
};

/// What the landmarks' names say of labels (UnderstandLabels) in the first recording that has
/// enough of them, and that the body there does not contradict. Where a recording's left and right
/// are exchanged (FindExchangedSides), a label is of the other side than its name says.
NamedPlaces FindNamedPlaces(const std::vector<std::string>& labels,
                            const std::vector<const MarkerSequence*>& recordings,
                            const NamedBody& body);

}  // namespace mmm_converter
