// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "common/model/kinematic_model.h"
#include "common/motion/marker_sequence.h"
#include "common/motion/pose_trajectory.h"
#include "common/support/text_pieces.h"

namespace mmm_converter {

/// The model marker that a recording label stands for.
struct TrcModelMarker {
  LabelIx label;
  MarkerIx marker;
};

/// What a TRC file is made of; all of it must outlive the text.
struct TrcOutput {
  std::string file_name;                     ///< what the first line names
  long first_frame = 1;                      ///< number of frame 0
  const MarkerSequence* measured = nullptr;  ///< must be there
  /// Also write where the model has these markers in the trajectory, which has a posture for each
  /// frame; joints that it does not name are 0.
  std::vector<TrcModelMarker> model_markers;
  const KinematicModel* model = nullptr;
  const PoseTrajectory* trajectory = nullptr;
};

/// Markers as a TRC file (Motion Analysis, OpenSim): the measured ones under their labels, then the
/// model's under the label they stand for + "_model". Millimetres; y up, as in OpenSim: x, y, z of
/// the file are x, z, -y of W. Not seen: empty cells. Blanks in labels become '_'. A tab ends every
/// cell of labels and rows, also the last: OpenSim's and BTK's readers need it.
/// @throws Error where the trajectory names a joint that the model does not have.
TextPieces FormatTrc(const TrcOutput& output);

}  // namespace mmm_converter
