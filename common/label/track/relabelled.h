// SPDX-License-Identifier: MIT
#pragma once

#include <set>
#include <string>
#include <vector>

#include "common/label/track/labelling.h"
#include "common/motion/marker_sequence.h"

namespace mmm_converter {

/// Frames [begin, end) that a point of the output has from a point of the recording.
struct PointStretch {
  int begin = 0, end = 0;
  LabelIx from;
};

/// A point of the output.
struct RelabelledPoint {
  std::string label;
  bool is_named = false;                ///< by the labelling
  LabelIx place;                        ///< the recording's point whose place it has
  std::vector<PointStretch> stretches;  ///< in order, without overlaps
};

/// The points of a recording under the names of a labelling. Nothing that was measured is lost:
/// what has no name stays with its point, under the label that it had, or as `*` and a number that
/// is free where that is one of the labelling's names. Labels that the recording had stay, also
/// where nothing of them is left; a point without a label goes where all of it has a name. A name
/// has the place of the point that was called so, else of the one that gives it most frames.
/// Where a point is not seen, its frames belong to the first point in its place, so that a
/// labelling that changes nothing gives each point all of its own frames. labels: the recording's.
std::vector<RelabelledPoint> RelabelledPoints(const Labelling& labelling,
                                              const std::vector<std::string>& labels,
                                              int num_frames);

/// The recording as these points. The same frames.
MarkerSequence Relabelled(const std::vector<RelabelledPoint>& points,
                          const MarkerSequence& recording);

/// Frames [begin, end) in which a point has another name than its label.
struct LabelChange {
  LabelIx point;  ///< column of the recording
  int begin = 0, end = 0;
  std::string from;        ///< its label; `*` and a number where it had none
  std::string to;          ///< empty: it has none now
  double probability = 0;  ///< the least of its pieces
};

/// By frame, then by point. Pieces of a point that get the same name one after the other are one
/// change. A point whose label is none of the labelling's names does not change where it gets no
/// name: it keeps its label.
std::vector<LabelChange> ChangesOf(const Labelling& labelling,
                                   const std::vector<std::string>& labels);

/// Gives points back their labels that have other names, or none, in all of their frames, as far as
/// these names are then free. A body whose markers' places are not known can't tell a label that is
/// wrong all along from a marker that is worn elsewhere. kept: labels that may be kept so.
void KeepLabelsOfAllFrames(const std::vector<std::string>& labels,
                           const std::set<std::string>& kept, Labelling* labelling);

}  // namespace mmm_converter
