// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "common/calibrate/calibration.h"
#include "common/convert/tracking_setup.h"
#include "common/judge/verdict.h"
#include "common/pipeline/input/converter_choice.h"
#include "common/pipeline/input/input.h"
#include "common/pipeline/input/person.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// What the user asked for. Empty: a default.
struct CalibrationRequest {
  std::vector<InputRequest> inputs;  ///< recordings of one person; person and model are the first's
  ConverterRequest converter;        ///< its configuration names markers and joints
  std::string name;                  ///< of the person
};

/// A recording of the person, and what of it is used.
struct CalibrationInput {
  Input input;
  TrackingSetup setup;  ///< on the reference model
};

/// Everything that a summary tells.
struct CalibrationReport {
  std::vector<CalibrationInput> recordings;
  Person person;                                ///< with the subject
  std::shared_ptr<const KinematicModel> model;  ///< fitted to the subject
  CalibrationResult result;
  Verdict verdict;
  Warnings warnings;
};

/// @throws Error where a calibration of so many joints or bodies would take too long.
void CheckIsSmallEnough(const std::string& model_file, int count, const char* what);

/// The recordings of the request with their markers matched: what names of one of them mean, they
/// mean in all. config: gets what belongs to the model. @throws Error
std::vector<CalibrationInput> ReadCalibrationInputs(const CalibrationRequest& request,
                                                    ConverterConfig* config,
                                                    const std::function<void(int, int)>& progress,
                                                    Warnings* warnings);

std::vector<CalibrationRecording> RecordingsOf(const std::vector<CalibrationInput>& inputs);

/// @throws Error where no person has such proportions: markers are not the person's.
void CheckProportions(const Subject& subject);

/// The verdict of a calibration. person: what the reference is scaled by; its subject does not
/// count.
Verdict MeasureAndJudge(const CalibrationResult& result,
                        const std::vector<CalibrationInput>& recordings,
                        const PersonScaling& person);

/// Reads the recordings, matches their markers, scales the model and estimates what is left.
/// configuration: names markers and joints. progress(done, all): recordings read; also, all of
/// them, often during the estimate, which ends by what it throws.
/// @throws Error; where recordings tell too little, with what is missing.
CalibrationReport RunCalibration(const CalibrationRequest& request,
                                 WithWarnings<ConverterConfig> configuration,
                                 const std::function<void(int, int)>& progress);

/// CalibrateSubject for a person whose height and mass are known: the result's subject is complete,
/// and as its file says it, so that a file gives what the calibration itself gave.
/// scaled: by the person's height and mass, of `reference`. between_steps: as CalibrationOptions.
CalibrationResult CalibratePerson(const KinematicModel& scaled, const std::vector<int>& joints,
                                  const std::vector<CalibrationRecording>& recordings,
                                  const Person& person, const std::string& name, Warnings* warnings,
                                  const std::function<void()>& between_steps = {});

/// What a subject file says of the program.
std::string SubjectProgram();

/// The person's name where none is given: of the recording's subject or motion, else of its file.
std::string SubjectName(const Input& input);

}  // namespace mmm_converter
