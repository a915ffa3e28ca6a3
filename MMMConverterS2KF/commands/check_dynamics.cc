// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <utility>

#include "MMMConverterS2KF/commands/commands.h"
#include "MMMConverterS2KF/commands/request_options.h"
#include "MMMConverterS2KF/report/dynamics_page.h"
#include "MMMConverterS2KF/report/dynamics_summary.h"
#include "MMMConverterS2KF/terminal/command_line.h"
#include "MMMConverterS2KF/terminal/log.h"
#include "common/pipeline/dynamics/dynamics_check.h"
#include "common/pipeline/input/input.h"
#include "common/support/atomic_file.h"

namespace mmm_converter {
namespace {

constexpr int kImplausible = 1;

const OptionGroup kCheckDynamicsFiles = {
    "Files",
    {{"summary", "FILE", "write all figures as JSON", ""},
     {"report", "FILE", "write a page (HTML) with plots", ""}}};

constexpr const char* kCheckDynamicsUsage = R"(MMMConverterS2KF check-dynamics MOTION [options]
Checks whether a human body can move like an MMM motion (1.0 or 2.0). Computes centre of mass,
momentum, forces, torques and power by inverse dynamics (Simbody) and compares them with the laws of
mechanics. Assumes level ground as the only contact of the body; z points up. With --forces (as
convert --export-grf writes them) motion and mass are compared with what was measured, too.

{}Checks, and what is plausible
  kinematics   Simbody and this program place the body within {:.0e} m of each other
  mean force   vertical, as 1 body weight and the change of velocity ask for, ± {:g} body weights
  ground       pulls with more than {:g} body weights, would need friction above {:g}, or would have
               to push more than {:.0f} mm beside what touches it: each in at most {:.0f} % of the
               frames on it; the body's lowest point is more than {:.0f} mm above or below it in at
               most as many of those in which something carries the body
  flight       the centre of mass falls with {:g} m/s² ± {:.0f} %; angular momentum about it varies by
               at most {:.0f} % (root mean square)
  torque       at most {:g} N m for each kg of the body, in joints that do not stand on the ground
Forces, flights and torques are not judged if accelerations are mostly noise (above {:g} body
weights rms, estimated from what the low-pass filter removes, or forces above {:g}), or if the frame
rate is too low for the filter. Ground contact is not judged on less than {:g} s. The filter also
uses the frames outside of --frames; the first and the last period (1 / HZ) of the whole motion are
left out of forces and torques. A torque is only known while nothing below the joint touches the
ground, as a motion does not tell how the feet share the weight.

The exit code is 1 if a check is implausible or the input cannot be read.

Examples
  MMMConverterS2KF check-dynamics walk_mmm.xml
  MMMConverterS2KF check-dynamics jump_mmm.xml --subject-file anna.xml --report jump.html
  MMMConverterS2KF check-dynamics run.xml --frames 100:400 --summary run.json --low-pass 10
)";

std::string Text() {
  return fmt::format(kCheckDynamicsUsage, "{}", kMostKinematicsError, kMostMeanForceError,
                     kForceTolerance, kMostFriction, 1000 * kMostOutsideSupport,
                     100 * kMostBadFrames, 1000 * kMostUneven, kGravity, 100 * kMostFallError,
                     100 * kMostMomentumVariation, kMostTorque, kMostNoise, kNoiseForce,
                     kLeastOnGround);
}

void WriteFiles(const Arguments& arguments, const DynamicsReport& report) {
  const std::string summary = arguments.Get("summary").value_or("");
  const std::string page = arguments.Get("report").value_or("");
  const CheckedMotion& motion = report.motion;
  FilesTogether files;
  if (!summary.empty()) WriteFileAtomically(summary, FormatJson(ToJson(report)));
  const std::string title = std::filesystem::path(motion.file).filename().string();
  if (!page.empty()) WriteFileAtomically(page, FormatDynamicsPage(title, report));
  files.Commit();
}

}  // namespace

Manual CheckDynamicsManual() {
  DynamicsOptions options;
  return {Text(), CommandOptions(task::kCheckDynamics, {kCheckDynamicsFiles},
                                 GroupsOf(Options(&options), task::kCheckDynamics))};
}

int RunCheckDynamics(const Arguments& arguments) {
  if (!arguments.positional()) {
    throw UsageError(
        "check-dynamics: which motion? For instance: MMMConverterS2KF check-dynamics walk_mmm.xml");
  }
  StartLog(arguments.Get("log").value_or("info"));
  const InputRequest request =
      MakeRequest(task::kCheckDynamics, arguments, *arguments.positional()).input;
  DynamicsOptions options;
  ReadArguments(arguments, Options(&options), task::kCheckDynamics);
  OutputPlan plan;
  NameInputs(request, &plan);
  for (const char* output : {"summary", "report"}) plan.Write(arguments.Get(output).value_or(""));
  plan.Check();
  CheckedMotion motion = ReadCheckedMotion(request);
  plan.Read(motion.model_file);
  plan.Check();
  const DynamicsReport report = CheckDynamics(std::move(motion), options);
  plan.Check();
  LogWarnings(report.motion.warnings);
  WriteFiles(arguments, report);
  std::cout << FormatDynamicsSummary(report);
  return report.plausibility.judgement == DynamicsJudgement::kImplausible ? kImplausible : 0;
}

}  // namespace mmm_converter
