// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "common/label/learn/learn_markers.h"
#include "common/pipeline/input/converter_choice.h"
#include "common/pipeline/input/input.h"
#include "common/pipeline/input/person.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// What was asked for.
struct LearnRequest {
  std::vector<InputRequest> inputs;  ///< recordings of one person; person and model are the first's
  ConverterRequest converter;        ///< its configuration names the joints
  std::string name;                  ///< of the marker set; empty: the output's file name
  std::string output;
  std::vector<std::string> more_outputs;  ///< that the caller writes
};

/// Everything that a summary tells.
struct LearnReport {
  std::vector<Input> inputs;
  Person person;
  LearnedMarkers learned;
  std::string name;    ///< of the marker set
  std::string output;  ///< its file
  Warnings warnings;
};

/// Reads the recordings, checks the outputs and learns the markers; writes nothing.
/// @throws Error
LearnReport RunLearning(const LearnRequest& request, const std::function<void(int, int)>& progress);

/// The marker set's file.
std::string FormatLearnedSet(const LearnReport& report);

}  // namespace mmm_converter
