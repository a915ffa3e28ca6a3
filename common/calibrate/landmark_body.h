// SPDX-License-Identifier: MIT
#pragma once

#include "common/convert/named_markers.h"
#include "common/convert/tracking_setup.h"
#include "common/model/subject.h"
#include "common/motion/marker_sequence.h"

namespace mmm_converter {

/// What distances between landmarks show of a person before any posture is known, as a subject of
/// scales and offsets without deviations, relative to the model of the setup; empty where the
/// landmarks are not there.
///
///   pelvis   width between the anterior iliac spines W and depth to the posterior ones D put the
///            hips 0.33 W + 7.3 mm to the side, 0.30 W + 10.9 mm below and 0.24 D + 9.9 mm behind
///            the anterior spines (Harrington et al. 2007, J. Biomech. 40, eqs. 7 to 9)
///   thigh    from there to the knee, half way between its epicondyles or beside the lateral one
///   shank    from the knee to the ankle, by their epicondyles and malleoli
///   foot     distances between malleolus, heel and metatarsals, and their heights above each other
///            where the foot is flat on the floor; without these the foot stays
///
/// Lengths of both sides are the same, but for what markers can't leave open. Distances are medians
/// over the recording, z is up.
Subject FindLandmarkBody(const TrackingSetup& setup, const NamedMarkers& names,
                         const MarkerSequence& recording);

}  // namespace mmm_converter
