// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/convert/marker_mapping.h"
#include "common/convert/motion_converter.h"
#include "common/convert/named_markers.h"
#include "common/fit/height_estimate.h"
#include "common/io/recording/recording.h"
#include "common/judge/evidence.h"
#include "common/judge/verdict.h"
#include "common/model/subject.h"
#include "common/study/body_figures.h"
#include "common/study/conversion_figures.h"
#include "common/study/label_figures.h"

namespace mmm_converter {

/// What the verdict of a conversion looks at.
struct ConversionEvidence {
  const Recording& recording;
  int first_frame = 0;  ///< of the recording in its file
  const std::vector<MarkerAssignment>& assignments;
  const ConversionResult& result;
  const ConversionFigures& figures;
  std::string object_model = {};        ///< the file of a rigid object's model; empty: a person
  const Subject* subject = nullptr;     ///< null: the person is not calibrated
  double height = 0;                    ///< by which the model was scaled [m]; 0: it has a size
  std::string height_source = {};       ///< empty: these markers, or there is none
  const NamedMarkers* names = nullptr;  ///< by which the labels were matched; null: by a set
  BodyFigures body = {};
  LabelFigures labels = {};                        ///< as far as asked for
  std::optional<HeightEstimate> told_height = {};  ///< the same
};

/// labels and told_height need not be there yet.
Questions AskAboutConversion(const ConversionEvidence& evidence);

/// By what the recording's markers, the person and the track are, beside what right recordings
/// have; conversion_verdict.cc has the limits.
Verdict JudgeConversion(const ConversionEvidence& evidence);

}  // namespace mmm_converter
