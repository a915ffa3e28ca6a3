// SPDX-License-Identifier: MIT
#pragma once

#include "common/convert/named_markers.h"
#include "common/io/recording/recording.h"
#include "common/judge/evidence.h"
#include "common/judge/verdict.h"
#include "common/study/label_figures.h"

namespace mmm_converter {

/// What the verdict of names that were found looks at.
struct LabelEvidence {
  const Recording& recording;
  const NamingFigures& naming;
  const LabelFit& fit;
  bool is_calibrated = false;  ///< the person
  double height = 0;           ///< of the person [m]
  /// What the body says of the names that are written; null: a marker set knows them.
  const NamedMarkers* names = nullptr;
  LabelFigures labels = {};  ///< as far as asked for
};

/// labels need not be there yet.
Questions AskAboutLabels(const LabelEvidence& evidence);

/// What the verdict of a conversion says of names, it says, too. label_verdict.cc has the limits.
Verdict JudgeLabels(const LabelEvidence& evidence);

}  // namespace mmm_converter
