// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>
#include <vector>

namespace mmm_converter {

class KinematicModel;
struct ConversionReport;

/// A format of a conversion's results for other programs. A row of Exporters() is all there is to
/// add: the option --export-NAME, the attribute of batches, the checks of outputs and the help
/// texts are made from it.
struct Exporter {
  const char* name = "";    ///< "csv": attribute and folder of a batch
  const char* option = "";  ///< "export-csv"
  const char* ending = "";  ///< of its files there
  const char* what = "";    ///< "postures as CSV", for the help of a batch
  const char* help = "";    ///< of the option
  /// @throws Error; the file is then as it was before.
  void (*write)(const std::string& file, const ConversionReport& report) = nullptr;
  /// Of covariances, which are kept where they are asked for before a whole recording is tracked.
  bool of_covariances = false;
  bool takes_covariances = false;  ///< says more where the converter has them
  /// @throws Error naming the file where it can't be made of that model. Null: of each it can.
  void (*check)(const std::string& file, const KinematicModel& model) = nullptr;
};

const std::vector<Exporter>& Exporters();

/// Files that are asked for, by the exporter's name.
using ExportFiles = std::map<std::string, std::string>;

/// Whether one of these is made of covariances.
bool NeedCovariances(const ExportFiles& files);
/// Whether one of these says more with them.
bool TakeCovariances(const ExportFiles& files);

/// @throws Error where one of these can't be written of that model.
void CheckExports(const ExportFiles& files, const KinematicModel& model);

/// @throws Error; each file is then as it was before, or whole.
void WriteExports(const ExportFiles& files, const ConversionReport& report);

}  // namespace mmm_converter
