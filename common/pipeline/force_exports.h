// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "common/pipeline/exporters.h"

namespace mmm_converter {

struct ConversionPlan;
class OutputPlan;

// Exports that are made of where feet stand and of what force plates measured. They write what
// StudyExports found.

/// When which foot is on the ground: JSON where the file is called so, else CSV.
void WriteContacts(const std::string& file, const ConversionReport& report);

/// The recording's C3D file with angles, moments and powers as points, and with events.
void WriteResults(const std::string& file, const ConversionReport& report);

/// Strides, and what angles, forces, moments and powers are over them: JSON where the file is
/// called so, else the latter as CSV.
void WriteGait(const std::string& file, const ConversionReport& report);
/// Of several recordings, each under its file's name.
void WriteGaitOf(const std::string& file, const std::vector<const ConversionReport*>& reports);

/// The ground's forces for OpenSim: a table, and beside it the ExternalLoads, called as the table
/// with ".xml".
void WriteGrf(const std::string& file, const ConversionReport& report);

/// Generalised forces of the joints, of inverse dynamics with the plates' forces: a table, as .sto
/// OpenSim's, or as .json what the residuals say.
void WriteJointForces(const std::string& file, const ConversionReport& report);

/// Before anything is tracked: reads the plates of a person's recording, whatever is asked for.
/// @throws Error where an export can't be made.
void ReadPlates(const ExportFiles& files, ConversionPlan* plan);

/// After it is tracked and before it is judged, whatever is exported: studies the ground where
/// there are plates.
void StudyPlates(ConversionReport* report);

/// Before exports are written: computes what these need, and warns of what they lack, where the
/// plates tell another mass than was given, or where motion and forces do not fit together. No
/// verdict depends on it.
/// @throws Error where one of these exports can't be made.
void StudyExports(const ExportFiles& files, ConversionReport* report);

/// Says in the plan which files exports write.
void NameOutputs(const ExportFiles& files, OutputPlan* plan);

}  // namespace mmm_converter
