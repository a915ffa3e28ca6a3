// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/dynamics/checked_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "MMMConverterS2KF/comparison_setup.h"
#include "common/io/mmm_motion.h"
#include "common/io/model_file.h"
#include "common/support/error.h"

namespace mmm_converter {
namespace {

namespace fs = std::filesystem;

std::string ChooseModel(const InputRequest& request, const MmmMotion& motion,
                        std::vector<std::string>* warnings) {
  if (!request.model_file.empty() || motion.model_path.empty()) return ModelFile(request);
  const fs::path named = fs::path(request.file).parent_path() / motion.model_path;
  std::error_code failure;
  if (fs::is_regular_file(named, failure)) return named.lexically_normal().string();
  std::string shipped = ModelFile(request);
  warnings->push_back(
      fmt::format("{}: names the model {}, which is not there; {} is taken (--model gives another)",
                  request.file, motion.model_path, shipped));
  return shipped;
}

void TakeFrames(const InputRequest& request, CheckedMotion* checked) {
  PoseTrajectory& trajectory = checked->trajectory;
  const int begin = request.first_frame.value_or(0);
  const int end =
      std::min(request.end_frame.value_or(trajectory.num_frames()), trajectory.num_frames());
  if (begin >= end) {
    throw Error(fmt::format("{}: --frames {}:{} has no frame of the motion's {}, counted from 0",
                            request.file, begin, end, trajectory.num_frames()));
  }
  trajectory.first_time = trajectory.time(begin);
  trajectory.postures = {trajectory.postures.begin() + begin, trajectory.postures.begin() + end};
  trajectory.standard_deviations.resize(0, 0);
  checked->first_frame = begin;
  for (int k = 0; k < trajectory.num_frames(); ++k) {
    const Posture& posture = trajectory.postures[k];
    if (posture.position.allFinite() && posture.orientation.coeffs().allFinite() &&
        posture.joint_angles.allFinite()) {
      continue;
    }
    throw Error(
        fmt::format("{}: frame {} (at {:.3f} s) has root poses or joint angles that are no "
                    "numbers, or none; choose others with --frames",
                    request.file, begin + k, trajectory.time(k)));
  }
}

// What a recording says of its person.
Recording PersonOf(const MmmMotion& motion) {
  Recording recording;
  recording.height = motion.height;
  recording.mass = motion.mass;
  recording.hand_length = motion.hand_length;
  return recording;
}

bool IsHeightKnown(const PersonRequest& person, const MmmMotion& motion) {
  return person.height || motion.height || !person.processor_file.empty() ||
         !person.subject_file.empty();
}

}  // namespace

CheckedMotion ReadCheckedMotion(const InputRequest& request) {
  MmmMotion motion = ReadPostures(request.file, request.reading.motion);
  if (!request.reading.motion.empty() && motion.name != request.reading.motion) {
    throw Error(fmt::format("{}: has no motion \"{}\" with joint angles; there is \"{}\"",
                            request.file, request.reading.motion, motion.name));
  }
  std::vector<std::string> warnings;
  const std::string model_file = ChooseModel(request, motion, &warnings);
  const LoadedModel loaded = ReadModelFile(model_file);
  warnings.insert(warnings.end(), loaded.warnings.begin(), loaded.warnings.end());
  ConverterConfig config;
  if (!loaded.is_reference) config.model_processor = "None";
  if (loaded.is_reference && !IsHeightKnown(request.person, motion)) {
    throw Error(fmt::format(
        "{}: does not say how tall the person is; give --height (and --mass), or --subject-file",
        request.file));
  }
  Person person;
  KinematicModel model =
      ScaleToPerson(request.person, loaded.model, PersonOf(motion), config, {}, &person, &warnings);
  CheckedMotion checked = {request.file,
                           motion.name,
                           0,
                           model_file,
                           std::move(person),
                           std::move(model),
                           std::move(motion.trajectory),
                           std::move(warnings)};
  TakeFrames(request, &checked);
  return checked;
}

}  // namespace mmm_converter
