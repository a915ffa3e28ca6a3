// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <utility>

#include "MMMConverterS2KF/commands/commands.h"
#include "MMMConverterS2KF/commands/request_options.h"
#include "MMMConverterS2KF/terminal/command_line.h"
#include "MMMConverterS2KF/terminal/log.h"
#include "common/motion/trajectory_derivatives.h"
#include "common/pipeline/dynamics/checked_motion.h"
#include "common/pipeline/input/input.h"
#include "common/pipeline/pose_output.h"
#include "common/support/atomic_file.h"
#include "common/support/output_plan.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

namespace fs = std::filesystem;

const std::vector<OptionGroup> kExportPosesOptions = {
    {"Files",
     {{"output,o", "FILE",
       "the table: .npz (NumPy) or .csv; of several motions a folder, with a file of each", ""},
      {"format", "npz|csv", "of files in a folder; default: npz", ""}}},
    {"Poses",
     {{"segments", "NAME,...", "of the model, or none; default: all", ""},
      {"points", "kit21|kit44|all|none",
       "kit21: the 21 points of the KIT Motion-Language data set; kit44: where each of its 44 "
       "joint "
       "angles turns; all: where every joint turns; none; default: kit21",
       ""},
      {"relative-to", "world|root", "the world, or the model's root; default: world", ""},
      {"rotation", "quaternion|vector|matrix", "a quaternion is w, x, y, z; default: quaternion",
       ""},
      {"velocities", "",
       "also velocities: central differences, for motions that are smooth (s2kf_offline)", ""}}}};

constexpr const char* kExportPosesUsage =
    R"(MMMConverterS2KF export-poses MOTION... -o FILE [options]
Writes where the segments of the body are in every frame of finished MMM motions: positions and
orientations of segments and of the file's objects, points of the body, and the centre of mass.
Metres; z is up in the world. README.md of the application says which columns and arrays there are.

{}Examples
  MMMConverterS2KF export-poses walk_mmm.xml -o walk.npz
  MMMConverterS2KF export-poses walk_mmm.xml -o hands.csv --segments LWy_joint,RWy_joint
  MMMConverterS2KF export-poses motions/*.xml -o poses --segments none --relative-to root
)";

struct PoseRequest {
  PoseChoice choice;
  bool has_velocities = false;
};

PoseRequest MakePoseRequest(const Arguments& arguments) {
  PoseRequest request;
  if (const auto names = arguments.Get("segments")) {
    request.choice.segments = Split(*names, ',');
    std::erase(request.choice.segments, "");
  }
  if (request.choice.segments.empty()) {
    throw UsageError("--segments: give the names of segments, all or none");
  }
  request.choice.points = arguments.GetChoice("points", PointSets(), request.choice.points);
  request.choice.relative_to_root =
      arguments.GetChoice("relative-to", {"world", "root"}, "world") == "root";
  request.choice.rotation = ParseRotationForm(
      arguments.GetChoice("rotation", {"quaternion", "vector", "matrix"}, "quaternion"));
  request.has_velocities = arguments.Has("velocities");
  return request;
}

bool HasTableEnding(const std::string& file) {
  const std::string ending = ToLower(fs::path(file).extension().string());
  return ending == ".npz" || ending == ".csv";
}

std::vector<std::string> OutputFiles(const Arguments& arguments) {
  const std::string output = arguments.Get("output").value_or("");
  const std::vector<std::string>& motions = arguments.positionals();
  const std::string format = arguments.GetChoice("format", {"npz", "csv"}, "npz");
  std::error_code failure;
  if (motions.size() == 1 && !fs::is_directory(output, failure)) {
    if (!HasTableEnding(output)) {
      throw UsageError(fmt::format(
          "export-poses: -o {}: give a name that ends with .npz or .csv, or a folder", output));
    }
    return {output};
  }
  if (HasTableEnding(output) && !fs::is_directory(output, failure)) {
    throw UsageError(fmt::format(
        "export-poses: -o {}: several motions have a file each; name a folder", output));
  }
  std::vector<std::string> files;
  files.reserve(motions.size());
  for (const std::string& motion : motions) {
    files.push_back(
        (fs::path(output) / (fs::path(motion).stem().string() + "." + format)).string());
  }
  return files;
}

// The frames that are asked for.
PoseTrajectory FramesOf(const CheckedMotion& motion, bool has_velocities) {
  PoseTrajectory part = motion.trajectory;
  if (has_velocities) Differentiate(&part);
  part.first_time = part.time(motion.begin);
  part.postures = {part.postures.begin() + motion.begin, part.postures.begin() + motion.end};
  if (has_velocities) {
    part.velocities =
        Eigen::MatrixXd(part.velocities.middleCols(motion.begin, motion.end - motion.begin));
  }
  return part;
}

void ExportMotion(const InputRequest& input, const PoseRequest& request, const std::string& output,
                  OutputPlan plan) {
  const CheckedMotion motion = ReadCheckedMotion(input);
  plan.Read(motion.model_file);
  plan.Check();
  BodySelection selection = SelectBodies(motion.model, request.choice);
  selection.objects = ObjectsBeside(motion.file, motion.name);
  LogWarnings(motion.warnings);
  const BodyPoses poses =
      ComputeBodyPoses(motion.model, FramesOf(motion, request.has_velocities), selection);
  WriteFileAtomically(output, FormatPoseFile(output, poses, request.choice.rotation));
  std::cout << fmt::format("{}: {} frames, {} segments, {} objects, {} points\n", output,
                           poses.num_frames(), poses.segments.size(), poses.objects.size(),
                           poses.points.size());
}

}  // namespace

Manual ExportPosesManual() {
  return {kExportPosesUsage, CommandOptions(task::kExportPoses, kExportPosesOptions), true};
}

int RunExportPoses(const Arguments& arguments) {
  if (arguments.positionals().empty() || !arguments.Get("output")) {
    throw UsageError(
        "export-poses: which motion, and which file is to be written? For instance: "
        "MMMConverterS2KF export-poses walk_mmm.xml -o walk.npz");
  }
  StartLog(arguments.Get("log").value_or("info"));
  const PoseRequest request = MakePoseRequest(arguments);
  const std::vector<std::string> outputs = OutputFiles(arguments);
  const bool is_folder = arguments.Get("output") != outputs.front();
  OutputPlan plan;
  NameInputs(MakeRequest(task::kExportPoses, arguments, "").input, &plan);
  for (const std::string& file : arguments.positionals()) plan.Read(file);
  for (const std::string& file : outputs) is_folder ? plan.WriteIntoFolder(file) : plan.Write(file);
  plan.Check();
  if (is_folder) {
    std::error_code failure;  // writing says what is wrong
    fs::create_directories(*arguments.Get("output"), failure);
  }
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    ExportMotion(MakeRequest(task::kExportPoses, arguments, arguments.positionals()[i]).input,
                 request, outputs[i], plan);
  }
  return 0;
}

}  // namespace mmm_converter
