// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "common/pipeline/input/input.h"

namespace mmm_converter {

/// Fills what a request leaves open with what a set-up of one of OpenSim's tools says: recording,
/// model, markers, weights of tasks, time range and external loads.
/// @throws Error as ParseOsimToolSetup and FindFileOfSetup, and where no recording is named.
void FillFromOsimSetup(const std::string& setup_file, InputRequest* request, Warnings* warnings);

/// The file with the tasks of a set-up that names one; else the file itself. What can't be read is
/// said where it is read.
std::string FileWithTasks(const std::string& file);

/// A file beside an OpenSim model, with a task set or the set-up of an InverseKinematicsTool, that
/// gives the model's markers unequal weights; empty: there is none.
std::string FindWeightsBeside(const std::string& model_file, const KinematicModel& model);

}  // namespace mmm_converter
