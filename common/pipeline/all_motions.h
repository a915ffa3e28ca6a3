// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/pipeline/conversion.h"

namespace mmm_converter {

/// What became of one motion of a file.
struct MotionOutcome {
  std::string name;
  std::optional<ConversionReport> report;  ///< empty: stays as it is in the file
  std::string failure;                     ///< empty: none, or it has no markers
};

struct AllMotions {
  Warnings warnings;                   ///< of the file as a whole; the others are in reports
  std::vector<MotionOutcome> motions;  ///< in the file's order
  std::string output;
};

/// Converts every motion with markers of an MMM 2.0 file, each by itself: what fails has its reason
/// and does not end the others. Writes nothing. progress as of RunConversion, for each motion.
/// @throws Error where the request fits one motion only, an output is a file that is read, or all
/// motions fail.
AllMotions RunAllMotions(const ConversionRequest& request,
                         const std::function<bool(int, int)>& progress);

/// Of the motions that were converted; they point into `all`.
std::vector<const ConversionReport*> ReportsOf(const AllMotions& all);

/// A name for each, no two equal: those of the files, with their folders where that tells them
/// apart; of motions of one file, the motions'.
std::vector<std::string> NamesOfReports(const std::vector<const ConversionReport*>& reports);

/// What speaks against strides of all of them together: other persons, other ways to walk, the same
/// frames twice.
std::vector<std::string> DoubtsTogether(const std::vector<const ConversionReport*>& reports);

/// Writes the models of the objects, and one file with all motions.
void WriteAllMotions(const ConversionRequest& request, AllMotions* all);

}  // namespace mmm_converter
