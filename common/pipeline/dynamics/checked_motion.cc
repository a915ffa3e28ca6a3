// SPDX-License-Identifier: MIT
#include "common/pipeline/dynamics/checked_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "common/io/mmm/mmm_motion.h"
#include "common/io/model_file.h"
#include "common/io/recording/recording_formats.h"
#include "common/pipeline/input/finished_motion.h"
#include "common/support/advice.h"
#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

namespace fs = std::filesystem;

void CheckIsNoRecording(const std::string& file) {
  const RecordingFormat* format = FindFormatOfContent(file);
  if (format == nullptr || format->holds_motions) return;
  throw Error(fmt::format("{}: is a {} recording, which has markers only; convert it first", file,
                          format->name));
}

// The only motion with joint angles, or the one of that name.
MmmMotion ReadChosenMotion(const std::string& file, const std::string& name) {
  CheckIsNoRecording(file);
  if (name.empty()) return ReadPostures(file, name);
  MmmMotionFile content = ReadMmmMotionFile(file);
  std::vector<std::string> others;
  for (MmmMotion& motion : content.motions) {
    if (motion.trajectory.num_frames() == 0 || motion.trajectory.joint_names.empty()) continue;
    if (motion.name == name) return std::move(motion);
    others.push_back(fmt::format("\"{}\"", motion.name));
  }
  const std::string there = others.empty() ? "none" : JoinNames(others);
  const MmmMotion* found = content.Find(name);
  if (found != nullptr && found->trajectory.num_frames() > 0) {
    throw Error(fmt::format(
        "{}: motion \"{}\" is that of a rigid object, without joints, which is not checked; with "
        "joint angles there is {}",
        file, name, there));
  }
  throw Error(
      fmt::format("{}: has no motion \"{}\" with joint angles; there is {}", file, name, there));
}

std::string ChooseModel(const InputRequest& request, const MmmMotion& motion, Warnings* warnings) {
  if (!request.model_file.empty() || motion.model_path.empty()) return ModelFile(request);
  const fs::path named = fs::path(request.file).parent_path() / motion.model_path;
  std::error_code failure;
  if (fs::is_regular_file(named, failure)) return named.lexically_normal().string();
  std::string shipped = ModelFile(request);
  warnings->Add(
      fmt::format("{}: names the model {}, which is not there; {} is taken ({} gives another)",
                  request.file, motion.model_path, shipped, OptionText("model")));
  return shipped;
}

// An error says where the model's name is from.
LoadedModel ReadModelOf(const InputRequest& request, const MmmMotion& motion,
                        const std::string& model_file, Warnings* warnings) {
  if (!request.model_file.empty() || motion.model_path.empty()) {
    return ReadModelFile(model_file, warnings);
  }
  try {
    return ReadModelFile(model_file, warnings);
  } catch (const Error& error) {
    throw Error(fmt::format("{}: names the model {}, which can't be read ({} gives another): {}",
                            request.file, motion.model_path, OptionText("model"), error.what()),
                error.remedy());
  }
}

bool IsKnown(const Posture& posture) {
  return posture.position.allFinite() && posture.orientation.coeffs().allFinite() &&
         posture.joint_angles.allFinite();
}

// Frames next to those that are checked stay, for the derivatives' sake.
void KeepFrames(const InputRequest& request, CheckedMotion* checked) {
  PoseTrajectory& trajectory = checked->trajectory;
  std::vector<Posture>& postures = trajectory.postures;
  const int begin = request.first_frame.value_or(0);
  const int end =
      std::min(request.end_frame.value_or(trajectory.num_frames()), trajectory.num_frames());
  if (begin >= end) {
    throw Error(fmt::format("{}: {} {}:{} has no frame of the motion's {}, counted from 0",
                            request.file, OptionText("frames"), begin,
                            request.end_frame.value_or(trajectory.num_frames()),
                            trajectory.num_frames()));
  }
  const auto unknown = std::find_if_not(postures.begin() + begin, postures.end(), IsKnown);
  const auto known_end = static_cast<int>(unknown - postures.begin());
  if (known_end < end) {
    throw Error(
        fmt::format("{}: frame {} (at {:.3f} s) has root poses or joint angles that are no "
                    "numbers, or none; choose others with {}",
                    request.file, known_end, trajectory.time(known_end), OptionText("frames")));
  }
  int known_begin = begin;
  while (known_begin > 0 && IsKnown(postures[known_begin - 1])) --known_begin;
  trajectory.first_time = trajectory.time(known_begin);
  postures = {postures.begin() + known_begin, postures.begin() + known_end};
  trajectory.standard_deviations.resize(0, 0);
  checked->first_frame = begin;
  checked->begin = begin - known_begin;
  checked->end = end - known_begin;
}

// What a recording says of its person.
Recording PersonOf(const MmmMotion& motion) {
  Recording recording;
  recording.mmm = MmmPart{};
  recording.mmm->size = motion.size;
  return recording;
}

bool IsHeightKnown(const PersonRequest& person, const MmmMotion& motion) {
  return person.size.height || motion.size.height || !person.processor_file.empty() ||
         !person.subject_file.empty();
}

}  // namespace

CheckedMotion ReadCheckedMotion(const InputRequest& request) {
  return CheckedMotionOf(ReadChosenMotion(request.file, request.reading.motion), request);
}

CheckedMotion CheckedMotionOf(const ConversionReport& conversion, const InputRequest& request) {
  const ConversionPlan& plan = conversion.plan;
  if (plan.object) {
    throw Error(request.file + ": is the motion of a rigid object, without joints");
  }
  CheckedMotion checked = {request.file,
                           plan.motion_name,
                           0,
                           plan.input.model_file,
                           plan.person,
                           *plan.setup.model,
                           conversion.result.trajectory,
                           {}};
  checked.forces_file = request.forces_file;
  KeepFrames(request, &checked);
  return checked;
}

CheckedMotion CheckedMotionOf(MmmMotion motion, const InputRequest& request) {
  if (motion.trajectory.num_frames() == 0 || motion.trajectory.joint_names.empty()) {
    throw Error(request.file + ": is no motion of a person: it has no joint angles");
  }
  Warnings warnings;
  const std::string model_file = ChooseModel(request, motion, &warnings);
  if (!warnings.empty() && !IsHeightKnown(request.person, motion)) {
    throw Error(
        fmt::format("{}: names the model {}, which is not there, and no height to scale another "
                    "by; give the model with {}, or a person's height with {}",
                    request.file, motion.model_path, OptionText("model"), OptionText("height")));
  }
  LoadedModel loaded = ReadModelOf(request, motion, model_file, &warnings);
  ConverterConfig config;
  if (!loaded.is_reference) config.model_processor = "None";
  if (loaded.is_reference && !IsHeightKnown(request.person, motion)) {
    throw Error(fmt::format("{}: does not say how tall the person is; give {} (and {}), or {}",
                            request.file, OptionText("height"), OptionText("mass"),
                            OptionText("subject-file")));
  }
  TrackingSetup setup;  // of a motion without markers
  setup.model = std::make_shared<const KinematicModel>(std::move(loaded.model));
  const Person person = FindPerson(request.person, setup, PersonOf(motion), config, &warnings);
  CheckedMotion checked = {request.file,
                           motion.name,
                           0,
                           model_file,
                           person,
                           ScaleModel(*setup.model, ScalingOf(person, config)),
                           std::move(motion.trajectory),
                           std::move(warnings)};
  checked.forces_file = request.forces_file;
  KeepFrames(request, &checked);
  return checked;
}

}  // namespace mmm_converter
