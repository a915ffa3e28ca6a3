// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "common/convert/named_markers.h"
#include "common/convert/tracking_setup.h"
#include "common/pipeline/input/input.h"

namespace mmm_converter {

struct MatchedLabels {
  TrackingSetup setup;
  std::shared_ptr<const NamedMarkers> names;  ///< null: a marker set knows the labels
};

/// The names that MatchLabels goes by; null: it does not.
std::shared_ptr<const NamedMarkers> UnderstoodNames(const MarkerLabels& labels, const Input& input,
                                                    const ConverterConfig& config);

/// MatchMarkers, by the names of the labels where no marker set is asked for and they tell more of
/// the body than the sets that know them: then the setup's model is the reference with the markers
/// that they mean, which the recording's frames judge, if it has any (UnderstandLabels).
/// @throws Error as MatchMarkers.
MatchedLabels MatchLabels(const MarkerLabels& labels, const Input& input,
                          const ConverterConfig& config, Warnings* warnings);

/// Whether every label that is seen is a name (not *12), and the marker set or the landmarks know
/// most of them.
bool AreAllNamed(const MarkerLabels& labels, const Input& input, const ConverterConfig& config);

/// The setup of MatchLabels; the input gets the rest.
TrackingSetup MatchLabels(const MarkerLabels& labels, Input* input, const ConverterConfig& config,
                          Warnings* warnings);

/// Says of clusters whose places the posture by the other markers told how far they are from where
/// such are usually worn, so that deviations do not take them for measured.
void TellPlaces(const Input& input, TrackingSetup* setup);

}  // namespace mmm_converter
