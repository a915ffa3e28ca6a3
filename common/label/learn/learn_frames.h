// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "common/model/posture.h"
#include "common/motion/marker_sequence.h"

namespace mmm_converter {

/// The labels of several recordings, each once.
struct CommonLabels {
  std::vector<std::string> names;
  std::vector<std::vector<int>> columns;  ///< by recording, by label; -1: it has none
};

CommonLabels FindCommonLabels(const std::vector<const MarkerSequence*>& recordings);

/// A frame that places are learnt on.
struct LearnFrame {
  int recording = 0;
  Eigen::Matrix3Xd z;  ///< 3 x labels [m]; NaN: not seen
  Posture posture;     ///< tracked joints; none before the first fit
};

/// About sixty frames, spread evenly over all recordings; of each part the one that shows most.
std::vector<LearnFrame> ChooseLearnFrames(const std::vector<const MarkerSequence*>& recordings,
                                          const CommonLabels& labels);

/// What a frame shows, 3 x points [m].
Eigen::Matrix3Xd SeenPoints(const LearnFrame& frame);

/// Standard deviations of the distances between labels over the frames, from percentiles, labels x
/// labels [m]; large where they are not known.
Eigen::MatrixXd DistanceDeviations(const std::vector<LearnFrame>& frames);

/// How well a label keeps its distances from the others of a site: the mean of the two least of
/// their deviations [m]; nothing where it has no others.
std::optional<double> DeviationFrom(int site, int label, const std::vector<int>& sites,
                                    const Eigen::MatrixXd& deviations);

/// Labels of one site that keep their distances, in groups. sites: by label, -1: none.
std::vector<std::vector<int>> RigidGroups(const std::vector<int>& sites,
                                          const Eigen::MatrixXd& deviations);

}  // namespace mmm_converter
