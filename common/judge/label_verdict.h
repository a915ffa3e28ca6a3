// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/convert/named_markers.h"
#include "common/convert/tracking_setup.h"
#include "common/io/recording/recording.h"
#include "common/judge/verdict.h"
#include "common/label/track/labelling.h"
#include "common/motion/pose_trajectory.h"
#include "common/support/units.h"

namespace mmm_converter {

/// How named points fit the person's markers in the best postures of some frames [m].
struct LabelFit {
  double mean_distance = kNaN, p95_distance = kNaN;  ///< NaN: too few are named
  double farthest = 0;                               ///< of a name, on average
  std::vector<std::string> far_names;                ///< beyond kMarkerMean on average
  double told_height = 0;                            ///< that the points tell; 0: not known
  /// These postures; the setup's labels are columns of their frames.
  TrackingSetup setup = {};
  MarkerSequence frames = {};
  PoseTrajectory trajectory = {};
};

/// What the verdict of names that were found looks at.
struct LabelEvidence {
  const Recording& recording;
  const Labelling& labelling;
  LabelFit fit;
  bool is_calibrated = false;  ///< the person
  double height = 0;           ///< of the person [m]
  /// What the body says of the names that are written; null: a marker set knows them.
  const NamedMarkers* names = nullptr;
  std::shared_ptr<const KinematicModel> reference = {};  ///< not scaled; null: sides are not judged
  PersonScaling person = {};
};

/// What the verdict of a conversion says of names, it says, too. label_verdict.cc has the limits.
Verdict JudgeLabels(const LabelEvidence& evidence);

/// Those that no point has in any frame.
std::vector<std::string> NamesNotFound(const Labelling& labelling);

}  // namespace mmm_converter
