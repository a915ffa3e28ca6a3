// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <set>
#include <string>
#include <vector>

#include "common/pipeline/conversion.h"
#include "common/support/text_pieces.h"

namespace mmm_converter {

// Work of which a program says only later what is to be written, as often as it likes. No output
// replaces a file that the work was made of.

struct FinishedConversion {
  ConversionRequest request;
  ConversionReport report;

  const PoseTrajectory& trajectory() const { return report.result.trajectory; }
};

/// RunConversion without outputs; names points first where that is asked for.
/// @throws Error
FinishedConversion FinishConversion(const ConversionRequest& request,
                                    const std::function<bool(int, int)>& progress);

/// Writes a text that a program made of a conversion.
/// @throws Error; the file is then as it was before, as with all that follow.
void SaveText(const FinishedConversion& conversion, const std::string& file,
              const TextPieces& text);

/// Writes the motion.
void SaveMotion(const std::string& file, FinishedConversion* conversion);

/// Writes an export (Exporters), and adds what there is to warn of.
void SaveExport(const std::string& name, const std::string& file, FinishedConversion* conversion);

struct FinishedCalibration {
  CalibrationRequest request;
  CalibrationReport report;
  std::set<std::string> opened;  ///< files; see OpenedFiles
};

/// RunCalibration; progress as of RunConversion. @throws Error
FinishedCalibration FinishCalibration(const CalibrationRequest& request,
                                      const std::function<bool(int, int)>& progress);

void SaveSubject(const FinishedCalibration& calibration, const std::string& file);

/// Writes the person's model, for other MMM programs.
void SaveSubjectsModel(const FinishedCalibration& calibration, const std::string& file);

/// A text in one piece.
TextPieces Whole(std::string text);

/// Writes a text that is made of inputs and of other files that were opened.
void WriteBeside(const std::vector<InputRequest>& inputs, const std::set<std::string>& opened,
                 const std::string& file, const TextPieces& text);

}  // namespace mmm_converter
