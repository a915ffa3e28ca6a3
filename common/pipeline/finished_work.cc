// SPDX-License-Identifier: MIT
#include "common/pipeline/finished_work.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "common/io/mmm/mmm_model_subject.h"
#include "common/io/mmm/subject_file.h"
#include "common/io/tables/osim_tables.h"
#include "common/pipeline/conversion_options.h"
#include "common/pipeline/force_exports.h"
#include "common/pipeline/motion_output.h"
#include "common/support/atomic_file.h"
#include "common/support/error.h"
#include "common/support/opened_files.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

/// What a conversion was made of.
OutputPlan PlanBeside(const FinishedConversion& conversion) {
  const ConversionPlan& made_of = conversion.report.plan;
  OutputPlan plan;
  plan.Read(made_of.opened);
  NameInputs(conversion.request.input, &plan);
  NameInputs(made_of.converter, &plan);
  plan.Read(made_of.person.subject_file);
  return plan;
}

void CheckIsExporter(const std::string& name) {
  std::vector<std::string> names;
  for (const Exporter& one : Exporters()) names.emplace_back(one.name);
  if (std::find(names.begin(), names.end(), name) != names.end()) return;
  throw Error(
      fmt::format("there is no export \"{}\"; there are {}", name, JoinNames(names, " and ")));
}

}  // namespace

TextPieces Whole(std::string text) {
  return [text = std::move(text)](const TextSink& sink) { sink(text); };
}

FinishedConversion FinishConversion(const ConversionRequest& request,
                                    const std::function<bool(int, int)>& progress) {
  if (const std::string wrong = Contradiction(request); !wrong.empty()) throw Error(wrong);
  ConversionPlan plan = PlanConversion(request, LabelFirst(request, {}, progress));
  return {request, CarryOut(std::move(plan), progress)};
}

void SaveText(const FinishedConversion& conversion, const std::string& file,
              const TextPieces& text) {
  OutputPlan plan = PlanBeside(conversion);
  plan.Write(file);
  plan.Check();
  WriteFileAtomically(file, text);
}

void SaveMotion(const std::string& file, FinishedConversion* conversion) {
  ConversionReport& report = conversion->report;
  conversion->request.output = file;
  ChooseMotionOutput(conversion->request, false, &report.plan);
  OutputPlan plan = PlanBeside(*conversion);
  plan.Rewrite(file, conversion->request.input.file);
  plan.WriteBeside(DeviationsOutput(report.plan), kOsimDeviations);
  plan.Check();
  FilesTogether files;
  WriteObjectModel(report.plan);
  WriteMotions(conversion->request, {&report});
  files.Commit();
}

void SaveExport(const std::string& name, const std::string& file, FinishedConversion* conversion) {
  ConversionReport& report = conversion->report;
  const ExportFiles exports = {{name, file}};
  CheckIsExporter(name);
  CheckExports(exports, *report.plan.setup.model);
  OutputPlan plan = PlanBeside(*conversion);
  NameOutputs(exports, &plan);
  plan.Check();
  StudyExports(exports, &report);
  Warnings told;  // what several exports have to say is said once
  told.AppendNew(report.warnings);
  report.warnings = std::move(told);
  FilesTogether files;
  WriteExports(exports, report);
  files.Commit();
}

FinishedCalibration FinishCalibration(const CalibrationRequest& request,
                                      const std::function<bool(int, int)>& progress) {
  if (request.inputs.empty()) throw Error("calibrate: which recordings?");
  const OpenedFiles opened;
  Warnings warnings;
  ConverterChoice choice = ChooseConverter(request.converter, &warnings);
  CalibrationReport report = RunCalibration(
      request, {std::move(choice.config), std::move(warnings)}, [&](int done, int all) {
        if (progress && !progress(done, all)) throw Error("ended before it was done");
      });
  return {request, std::move(report), opened.files()};
}

void SaveSubject(const FinishedCalibration& calibration, const std::string& file) {
  WriteBeside(calibration.request.inputs, calibration.opened, file,
              Whole(FormatSubject(calibration.report.result.subject, SubjectProgram())));
}

void SaveSubjectsModel(const FinishedCalibration& calibration, const std::string& file) {
  const std::string& model = calibration.report.recordings.front().input.model_file;
  WriteBeside(calibration.request.inputs, calibration.opened, file,
              Whole(ReadModelForSubject(model, calibration.report.result.subject)));
}

void WriteBeside(const std::vector<InputRequest>& inputs, const std::set<std::string>& opened,
                 const std::string& file, const TextPieces& text) {
  OutputPlan plan;
  for (const InputRequest& input : inputs) NameInputs(input, &plan);
  plan.Read(opened);
  plan.Write(file);
  plan.Check();
  WriteFileAtomically(file, text);
}

}  // namespace mmm_converter
