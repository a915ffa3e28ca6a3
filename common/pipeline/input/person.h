// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/convert/converter_config.h"
#include "common/convert/named_markers.h"
#include "common/convert/tracking_setup.h"
#include "common/io/recording/recording.h"
#include "common/model/body_size.h"
#include "common/model/kinematic_model.h"
#include "common/model/subject.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// What the user says of the recorded person. Empty: a default.
struct PersonRequest {
  std::string processor_file;  ///< ModelProcessorConfig
  std::string subject_file;    ///< comes before the configuration's
  BodySize size;
};

/// Whether anything is.
bool IsGiven(const PersonRequest& request);

/// A number of the person, and where it is from.
struct PersonValue {
  double value = 0;
  std::string source;  ///< "given", a file, "assumed", "estimated from the recording"
};

/// Nobody said it, nor does anything tell it.
bool IsAssumed(const PersonValue& value);
/// A mass that nobody said, but plates bore [kg]; the model has the assumed one.
PersonValue MassByForcePlates(double mass);
bool IsByPlates(const PersonValue& value);

struct Person {
  PersonValue height, mass;
  double height_deviation = 0;  ///< of a height that the markers tell [m]; else 0
  std::optional<double> hand_length;
  std::shared_ptr<const Subject> subject;  ///< null: height and mass are all that is known
  std::string subject_file;                ///< empty: none
  /// Without a subject, what distances between landmarks show; null: no name is a landmark's.
  std::shared_ptr<const Subject> landmarks = {};
};

/// For messages: metres, their deviation where the markers tell them, and where they are from.
std::string DescribeHeight(const Person& person);

/// For messages: which file has it that the model is not scaled.
std::string WhyUnscaled(const ConverterConfig& config);

/// What a model is scaled by for a person; no size where the configuration says that it is not.
PersonScaling ScalingOf(const Person& person, const ConverterConfig& config);

/// The recorded person: the subject where the request or the configuration names one. Height, mass
/// and hand length are the subject's, or else are taken from the request, the processor file, or
/// the recording, in this order; then the height is estimated from the markers of the setup, which
/// MatchMarkers made, and the mass assumed. Nothing of these where the model is not scaled
/// (`<Model name="None">`; MatchModel).
/// @throws Error; also where the user gives another height or hand length than the subject's, which
///         its segment scales are relative to.
/// names: by which MatchLabels made the setup; null: it did not.
Person FindPerson(const PersonRequest& request, const TrackingSetup& setup,
                  const Recording& recording, const ConverterConfig& config, Warnings* warnings,
                  const NamedMarkers* names = nullptr);

/// As FindPerson, of a recording whose points have no names yet: the height can't be estimated.
/// @throws Error as FindPerson, and where the height is not known.
Person FindPersonOfPoints(const PersonRequest& request, const KinematicModel& reference,
                          const Recording& recording, const ConverterConfig& config,
                          Warnings* warnings);

/// As FindPerson without a recording: nothing is estimated or assumed.
/// @throws Error; also where height or mass are not known, or the model is not scaled.
Person FindKnownPerson(const PersonRequest& request, const KinematicModel& reference,
                       const ConverterConfig& config, Warnings* warnings);

}  // namespace mmm_converter
