// SPDX-License-Identifier: MIT
#pragma once

#include "common/convert/tracking_setup.h"
#include "common/pipeline/input/input.h"

namespace mmm_converter {

/// Where labels of head and feet spoke against the up axis that the recording's file states, and
/// the trunk, of postures fitted to all labels in up to twelve frames, is upright by the file and
/// not by them, the file is right: the recording is turned. setup: of the reference, not scaled.
void LetTrunkDecideUpAxis(const TrackingSetup& setup, Input* input, Warnings* warnings);

}  // namespace mmm_converter
