// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <filesystem>
#include <iostream>

#include "MMMConverterS2KF/commands/commands.h"
#include "MMMConverterS2KF/commands/request_options.h"
#include "MMMConverterS2KF/terminal/command_line.h"
#include "MMMConverterS2KF/terminal/log.h"
#include "common/io/urdf/urdf_model_writer.h"
#include "common/pipeline/input/input.h"
#include "common/support/atomic_file.h"

namespace mmm_converter {
namespace {

const OptionGroup kExportUrdfFiles = {"Files", {{"output,o", "FILE", "the URDF", ""}}};

constexpr const char* kExportUrdfUsage =
    R"(MMMConverterS2KF export-urdf --height H --mass M -o FILE [options]
Writes the MMM model of a person as a URDF: joints with limits, masses, inertia, simple shapes, and
markers as fixed links MARKER_..._marker. convert --model reads it like any other URDF.

{}Examples
  MMMConverterS2KF export-urdf --height 1.75 --mass 70 -o anna.urdf
  MMMConverterS2KF export-urdf --subject-file anna.xml -o anna.urdf
)";

/// Of the model by its file: its own name need not say anything.
std::string Describe(const std::string& model_file, const Person& person) {
  return fmt::format("{} as a person of {:.6g} m and {:.6g} kg{}",
                     std::filesystem::path(model_file).filename().string(), person.height.value,
                     person.mass.value,
                     person.subject ? ", the subject " + person.subject->name : "");
}

}  // namespace

Manual ExportUrdfManual() {
  return {kExportUrdfUsage, CommandOptions(task::kModel, {kExportUrdfFiles})};
}

int RunExportUrdf(const Arguments& arguments) {
  const auto output = arguments.Get("output");
  if (!output || arguments.positional()) {
    throw UsageError(
        "export-urdf: which file is to be written? For instance: MMMConverterS2KF export-urdf "
        "--height 1.75 --mass 70 -o anna.urdf");
  }
  StartLog(arguments.Get("log").value_or("info"));
  const InputRequest request = MakeRequest(task::kModel, arguments, "").input;
  OutputPlan plan;
  NameInputs(request, &plan);
  plan.Write(*output);
  plan.Check();
  Warnings warnings;
  Input input = ReadModel(request, {}, &warnings);
  ConverterConfig config;
  MatchModel(request, &input, &config);
  const Person person = FindKnownPerson(request.person, *input.reference, config, &warnings);
  plan.Check();
  const KinematicModel model = ScaleModel(*input.reference, ScalingOf(person, config));
  const UrdfText urdf = FormatUrdf(model, Describe(input.model_file, person), &warnings);
  LogWarnings(warnings);
  if (!urdf.renamed.empty()) LogInfo(urdf.renamed);
  WriteFileAtomically(*output, urdf.xml);
  std::cout << fmt::format("{}: {}; {} links, {} joints that turn, {} markers, {:.6g} kg\n",
                           *output, Describe(input.model_file, person), model.segments().size(),
                           model.num_joints(), model.markers().size(), model.total_mass());
  return 0;
}

}  // namespace mmm_converter
