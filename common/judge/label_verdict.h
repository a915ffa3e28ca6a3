// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "common/io/recording/recording.h"
#include "common/judge/verdict.h"
#include "common/label/track/labelling.h"

namespace mmm_converter {

/// What the verdict of names that were found looks at.
struct LabelEvidence {
  const Recording& recording;
  const Labelling& labelling;
  double mean_distance = 0;    ///< of named points from the person's markers [m]
  bool is_calibrated = false;  ///< the person
};

/// label_verdict.cc has the limits.
Verdict JudgeLabels(const LabelEvidence& evidence);

/// Those that no point has in any frame.
std::vector<std::string> NamesNotFound(const Labelling& labelling);

}  // namespace mmm_converter
