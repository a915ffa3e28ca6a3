// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "MMMConverterS2KF/batch/batch_outputs.h"
#include "MMMConverterS2KF/batch/manifest.h"
#include "MMMConverterS2KF/batch/shared_inputs.h"
#include "common/pipeline/dynamics/retarget_run.h"

namespace mmm_converter {

/// Converts an entry; writes nothing. request: RequestOf the entry.
/// goes_on: asked between frames; false ends it with an Error.
/// @throws Error
ConversionReport ConvertEntry(const ConversionRequest& request, const ReadBefore& read_before,
                              const std::function<bool()>& goes_on);

/// An entry's request with its outputs.
ConversionRequest RequestOf(const BatchEntry& entry, const BatchFolder& folder);

/// Brings what was converted to the entry's robot; nothing: it has none. Writes nothing.
/// @throws Error
std::optional<RetargetReport> RetargetEntry(const BatchEntry& entry, const BatchFolder& folder,
                                            const ConversionReport& report);

/// Writes the robot's motion and its exports. @throws WriteError
void WriteRobotOutputs(const BatchEntry& entry, const BatchFolder& folder, RetargetReport* robot);

/// JournalRecord::inputs of the files that were opened. fingerprinted: what the fingerprint is of.
/// @throws Error where one can't be read.
std::map<std::string, FileState> InspectInputs(const BatchEntry& entry,
                                               const std::set<std::string>& opened,
                                               const std::set<std::string>& fingerprinted);

/// Whether these are as they were; one that is gone is not.
bool AreInputsUnchanged(const BatchEntry& entry, const JournalRecord& record);

/// Writes the page of a conversion, or of the robot's motion where there is one.
/// @throws WriteError
void WritePage(const BatchEntry& entry, const ConversionReport& report,
               const std::optional<RetargetReport>& robot, BatchFolder* folder);

}  // namespace mmm_converter
