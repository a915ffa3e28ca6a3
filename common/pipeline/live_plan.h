// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "common/io/recording/recording.h"
#include "common/pipeline/conversion.h"
#include "common/pipeline/live_request.h"

namespace mmm_converter {

/// The conversion of a stream that has these labels; where points are named by the body, the plan's
/// recording has the names instead (ConversionPlan::labels). head: what is known of the stream
/// beyond its frames; its markers are the frames that have come until now, or those of the file
/// that is played, which only an unknown height and labels that are understood by names need.
/// @throws Error as PlanConversion; where the height is not known and too few frames tell it, one
/// whose remedy is a height.
ConversionPlan PlanLive(const LiveRequest& request, const Recording& head);

/// The person of a plan, as the frames show them. @throws Error where these tell too little.
struct LiveCalibration {
  CalibrationResult result;
  Person person;
  TrackingSetup setup;
  Warnings warnings;
};
LiveCalibration CalibrateLive(const ConversionPlan& plan, const MarkerSequence& frames);

/// A tracker's converter for a setup of the plan. @throws Error
std::unique_ptr<MotionConverter> MakeConverter(const ConversionPlan& plan,
                                               const TrackingSetup& setup);

}  // namespace mmm_converter
