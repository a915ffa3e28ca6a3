// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "common/pipeline/comparison/comparison.h"

namespace mmm_converter {

/// An experiment of the evaluation.
struct Experiment {
  std::string name;   ///< in the JSON: "complete", "occlusion", ...
  std::string title;  ///< for people
  std::string text;   ///< what is done and why
  Comparison comparison;
};

struct EvaluationRequest {
  int runs = 100;             ///< of the occlusion experiment
  int jobs = 0;               ///< as ComparisonOptions
  std::vector<Trial> others;  ///< recordings that are compared beside the handstand
};

/// Of all experiments that there may be.
std::vector<std::string> ExperimentNames();

/// The evaluation of the paper [S15] on a synthetic handstand: complete data, occlusion, then the
/// filters among themselves at falling frame rates. progress(title, done, all): runs.
std::vector<Experiment> Evaluate(const EvaluationRequest& request,
                                 const std::function<void(const std::string&, int, int)>& progress);

/// What the paper reports beside what was measured, as a Markdown table.
std::string FormatPaperTable(const std::vector<Experiment>& experiments);

}  // namespace mmm_converter
