// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "common/model/kinematic_model.h"
#include "common/motion/marker_sequence.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// The labels of a recording or a live stream, in the order of its columns.
struct MarkerLabels {
  std::vector<std::string> names;
  std::vector<bool> seen = {};  ///< by label, in some frame; empty: all may be, as of a stream
  std::string source = {};      ///< for messages: the file; may be empty
};

/// Of a whole recording: `seen` tells which of them are in some frame.
MarkerLabels LabelsOf(const MarkerSequence& recording, const std::string& source = {});

/// One line of a MarkerMapping: a recording label stands for a model marker.
struct MarkerPair {
  std::string source;  ///< recording label
  std::string target;  ///< model marker, e.g. MARKER_C7
  double noise_scale =
      1.0;  ///< factor on the marker noise standard deviation; larger trusts it less
  std::string warning = {};  ///< shown where the pair is used
};

/// A MarkerPair resolved once into indices.
struct MarkerAssignment {
  LabelIx label;  ///< into MarkerLabels::names too
  MarkerIx marker;
  double noise_scale = 1.0;
};

struct MarkerMapping {
  std::vector<MarkerAssignment> assignments;  ///< by model marker index, each marker at most once
  std::vector<std::string> ignored_labels;    ///< in the recording, not mapped
  std::vector<std::string> absent_markers;    ///< mapped, but not seen in the recording
};

/// Of each assignment, in their order.
std::vector<LabelIx> LabelIndices(const std::vector<MarkerAssignment>& assignments);
std::vector<MarkerIx> MarkerIndices(const std::vector<MarkerAssignment>& assignments);
Eigen::VectorXd NoiseScales(const std::vector<MarkerAssignment>& assignments);

/// Matches labels without case, blanks, punctuation and prefix (`Subject:`). Of several pairs with
/// the same target, the first whose label is seen is used: the later ones are substitutes.
/// @throws Error where no label matches (the message shows labels of both sides), a label is mapped
/// to
///         two markers, or a target is not a marker of the model.
MarkerMapping ResolveMarkerMapping(const std::vector<MarkerPair>& pairs, const MarkerLabels& labels,
                                   const KinematicModel& model, Warnings* warnings = nullptr);

}  // namespace mmm_converter
