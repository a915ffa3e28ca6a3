// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include "common/convert/motion_converter.h"
#include "common/convert/named_markers.h"
#include "common/convert/tracking_setup.h"
#include "common/io/recording/recording.h"
#include "common/judge/conversion_figures.h"
#include "common/judge/verdict.h"
#include "common/model/kinematic_model.h"

namespace mmm_converter {

/// What the verdict of a conversion looks at.
struct ConversionEvidence {
  const Recording& recording;
  int first_frame = 0;  ///< of the recording in its file
  const TrackingSetup& setup;
  std::shared_ptr<const KinematicModel> reference;  ///< not scaled
  std::string model_file;                           ///< of that
  bool is_object = false;
  PersonScaling person;       ///< what the reference is scaled by
  std::string height_source;  ///< of the height; empty: these markers, or there is none
  const ConversionResult& result;
  const ConversionFigures& figures;
  const NamedMarkers* names = nullptr;  ///< by which the labels were matched; null: by a set
};

/// By what the recording's markers, the person and the track are, beside what right recordings
/// have; conversion_verdict.cc has the limits.
Verdict JudgeConversion(const ConversionEvidence& evidence);

}  // namespace mmm_converter
