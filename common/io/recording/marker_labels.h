// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/support/warnings.h"

namespace mmm_converter {

/// Labels are compared without case, blanks and punctuation: "R.Knee Medial" is "rkneemedial".
std::string NormalizeLabel(std::string_view label);

/// Where a marker is worn, as far as that helps to tell a person from an object and up from down.
enum class BodyRegion { kHead, kShoulders, kThorax, kPelvis, kFeet, kElsewhere };

/// Of the labels of one recording, without subject; nothing for one that is no landmark's
/// (ReadLabels).
std::vector<std::optional<BodyRegion>> BodyRegionsOf(const std::vector<std::string>& labels);

/// The labels of one subject, and where they are in the file.
struct LabelSelection {
  std::vector<int> indices;
  std::vector<std::string> labels;    ///< without prefix, in UTF-8, each once
  std::vector<std::string> subjects;  ///< all prefixes of the file
  std::string subject;  ///< the one chosen; empty: labels without prefix, or of several prefixes
};

/// Leaves out unlabelled points (*12), what outputs lists, and the bone axes of Plug-in Gait (xxxO,
/// xxxA, xxxL and xxxP together), then chooses among the subjects, by `Subject:LABEL` or
/// `Subject_LABEL`: the one asked for, or several that are asked for as one ("Legs,Trunk"); else
/// those that together wear each landmark of a body once, or the only one that wears such
/// landmarks. Those without prefix are asked for as "". Who is not seen in any frame, or is
/// Cortex's computed markers (V_LASI) beside a person, is nobody. label_prefixes: what the file
/// declares, may be empty. file: for messages. with_unlabelled: points without a label stay,
/// whoever wears them, in their places. are_seen: by label, whether any frame shows it; asked only
/// where there are several subjects; may be empty.
/// @throws Error that lists the subjects where the choice is not clear or there is no such one.
LabelSelection SelectLabels(const std::vector<std::string>& labels,
                            const std::vector<std::string>& outputs,
                            const std::vector<std::string>& label_prefixes,
                            const std::optional<std::string>& subject, const std::string& file,
                            Warnings* warnings, bool with_unlabelled = false,
                            const std::function<std::vector<bool>()>& are_seen = {});

/// The labels of all subjects, with their prefixes: Subject:LABEL.
LabelSelection SelectAllSubjects(const std::vector<std::string>& labels,
                                 const std::vector<std::string>& outputs,
                                 const std::vector<std::string>& label_prefixes,
                                 Warnings* warnings);

}  // namespace mmm_converter
