// SPDX-License-Identifier: MIT
#include "common/pipeline/pose_output.h"

#include <fmt/format.h>

#include <utility>

#include "common/io/mmm/mmm_motion.h"
#include "common/io/recording/recording_formats.h"
#include "common/model/model_points.h"
#include "common/support/error.h"
#include "common/support/suggestion.h"

namespace mmm_converter {
namespace {

std::vector<int> FindSegments(const KinematicModel& model, const std::vector<std::string>& names) {
  std::vector<int> segments;
  if (names == std::vector<std::string>{"none"}) return segments;
  const bool is_all = names == std::vector<std::string>{"all"};
  std::vector<std::string> known;
  for (const Segment& segment : model.segments()) {
    if (is_all) segments.push_back(static_cast<int>(known.size()));
    known.push_back(segment.name);
  }
  if (is_all) return segments;
  for (const std::string& name : names) {
    segments.push_back(model.FindSegment(name));
    if (segments.back() >= 0) continue;
    const std::string closest = ClosestName(name, known);
    throw Error(fmt::format("the model {} has no segment \"{}\"{}", model.name(), name,
                            closest.empty() ? "" : " (did you mean " + closest + "?)"));
  }
  return segments;
}

}  // namespace

const std::vector<std::string>& PointSets() {
  static const std::vector<std::string> sets = {"kit21", "kit44", "all", "none"};
  return sets;
}

BodySelection SelectBodies(const KinematicModel& model, const PoseChoice& choice) {
  BodySelection selection;
  selection.segments = FindSegments(model, choice.segments);
  if (choice.points == "kit21") selection.points = KitPoints(model);
  if (choice.points == "kit44") selection.points = KitJointPoints(model);
  if (choice.points == "all") selection.points = JointPoints(model);
  selection.relative_to_root = choice.relative_to_root;
  return selection;
}

std::vector<ObjectMotion> ObjectsBeside(const std::string& file, const std::string& motion) {
  std::vector<ObjectMotion> objects;
  const RecordingFormat* format = FindFormatOfContent(file);
  if (format == nullptr || !format->holds_motions) return objects;
  for (MmmMotion& one : ReadMmmMotionFile(file).motions) {
    const bool is_object =
        one.name != motion && one.trajectory.num_frames() > 0 && one.trajectory.joint_names.empty();
    if (is_object) objects.push_back({one.name, std::move(one.trajectory)});
  }
  return objects;
}

}  // namespace mmm_converter
