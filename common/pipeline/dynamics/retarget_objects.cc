// SPDX-License-Identifier: MIT
#include "common/pipeline/dynamics/retarget_objects.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <utility>

#include "common/io/mmm/mmm_motion.h"
#include "common/io/model_file.h"
#include "common/motion/body_poses.h"
#include "common/pipeline/object.h"
#include "common/support/advice.h"
#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

namespace fs = std::filesystem;

constexpr int kMostFrames = 100;  // whose markers tell an object's size

bool IsFile(const std::string& file) {
  std::error_code failure;
  return fs::is_regular_file(file, failure);
}

std::vector<std::string> NamesOf(const std::string& text) {
  const std::size_t names = FileOfObjects(text).size() + 1;
  return names > text.size() ? std::vector<std::string>() : Split(text.substr(names), ',');
}

std::vector<MmmMotion> ObjectsOf(const std::string& file, const std::vector<std::string>& wanted) {
  std::vector<MmmMotion> objects;
  std::vector<std::string> there;
  for (MmmMotion& motion : ReadMmmMotionFile(file).motions) {
    if (motion.trajectory.num_frames() == 0 || !motion.trajectory.joint_names.empty()) continue;
    there.push_back(motion.name);
    if (wanted.empty() || std::count(wanted.begin(), wanted.end(), motion.name) > 0) {
      objects.push_back(std::move(motion));
    }
  }
  if (there.empty()) {
    throw Error(fmt::format(
        "{}: {} expects motions of rigid objects, with poses and without joints, and there is "
        "none; convert writes them",
        file, OptionText("objects")));
  }
  for (const std::string& name : wanted) {
    if (std::count(there.begin(), there.end(), name) > 0) continue;
    throw Error(
        fmt::format("{}: has no object \"{}\"; there is {}", file, name, FirstNames(there)));
  }
  return objects;
}

Eigen::AlignedBox3d ExtentOf(const RecordedObject& object) {
  Eigen::AlignedBox3d extent;
  const MarkerSequence& markers = object.recorded.markers;
  const PoseTrajectory& poses = object.recorded.trajectory;
  const int every = std::max(1, poses.num_frames() / kMostFrames);
  for (int k = 0; k < poses.num_frames() && markers.num_labels() > 0; k += every) {
    const auto frame = std::lround((poses.time(k) - markers.first_time()) * markers.rate());
    if (frame < 0 || frame >= markers.num_frames()) continue;
    const Posture& pose = poses.postures[k];
    const auto places = markers.frame(static_cast<int>(frame));
    for (Eigen::Index i = 0; i < places.cols(); ++i) {
      const Eigen::Vector3d p = pose.orientation.conjugate() * (places.col(i) - pose.position);
      if (p.allFinite()) extent.extend(p);
    }
  }
  const std::string model = NamedModel(object);
  if (!extent.isEmpty() || model.empty()) return extent;
  try {
    const Eigen::Matrix3Xd places = PlacesOfMarkers(ReadModelFile(model, nullptr).model);
    for (Eigen::Index i = 0; i < places.cols(); ++i) extent.extend(Eigen::Vector3d(places.col(i)));
  } catch (const Error&) {  // its size is not known then
  }
  return extent;
}

}  // namespace

std::string NamedModel(const RecordedObject& object) {
  const fs::path named = fs::path(object.file).parent_path() / object.recorded.model_path;
  return object.recorded.model_path.empty() || !IsFile(named) ? ""
                                                              : named.lexically_normal().string();
}

std::string FileOfObjects(const std::string& text) {
  const std::size_t colon = text.rfind(':');
  return IsFile(text) ? text : text.substr(0, colon);
}

std::vector<RecordedObject> ReadObjects(const std::vector<std::string>& texts) {
  std::vector<RecordedObject> objects;
  std::set<std::string> names;
  for (const std::string& text : texts) {
    const std::string file = FileOfObjects(text);
    if (file.empty()) throw Error(OptionText("objects") + ": names no file");
    for (MmmMotion& motion : ObjectsOf(file, NamesOf(text))) {
      if (!names.insert(motion.name).second) {
        throw Error(fmt::format("{}: {} names the object \"{}\" twice", file, OptionText("objects"),
                                motion.name));
      }
      objects.push_back({file, std::move(motion)});
    }
  }
  return objects;
}

std::vector<TrackedObject> AlignObjects(const PoseTrajectory& person,
                                        const std::vector<RecordedObject>& objects,
                                        Warnings* warnings) {
  std::vector<TrackedObject> aligned;
  for (const RecordedObject& object : objects) {
    const PoseTrajectory& poses = object.recorded.trajectory;
    TrackedObject& motion = aligned.emplace_back();
    motion.name = object.recorded.name;
    motion.extent = ExtentOf(object);
    int begin = 0, known = 0;
    for (int k = 0; k < person.num_frames(); ++k) {
      motion.X_WO.push_back(PoseAt(poses, person.time(k)));
      if (!motion.X_WO.back().matrix().allFinite()) {
        begin = k + 1;
        continue;
      }
      ++known;
      if (k + 1 - begin <= motion.end - motion.begin) continue;
      motion.begin = begin;
      motion.end = k + 1;
    }
    if (known > motion.end - motion.begin) {
      warnings->Add(fmt::format(
          "{}: \"{}\" is not known all the time: only its longest part without a gap comes along, "
          "{:.2f} to {:.2f} s, {:.2f} s of {:.2f} s",
          object.file, motion.name, person.time(motion.begin), person.time(motion.end - 1),
          (motion.end - motion.begin) / person.rate, known / person.rate));
    }
    if (known > 0) continue;
    throw Error(fmt::format(
        "{}: \"{}\" is known from {:.3f} s to {:.3f} s, the person from {:.3f} s to {:.3f} s: they "
        "have to be of one recording",
        object.file, motion.name, poses.first_time, poses.time(poses.num_frames() - 1),
        person.first_time, person.time(person.num_frames() - 1)));
  }
  return aligned;
}

PoseTrajectory PosesOf(const TrackedObject& object, const PoseTrajectory& frames) {
  PoseTrajectory poses = PosesAlways(object, frames);
  poses.first_time = frames.time(object.begin);
  poses.postures = {poses.postures.begin() + object.begin, poses.postures.begin() + object.end};
  return poses;
}

PoseTrajectory PosesAlways(const TrackedObject& object, const PoseTrajectory& frames) {
  PoseTrajectory poses;
  poses.rate = frames.rate;
  poses.first_time = frames.first_time;
  for (int k = 0; k < frames.num_frames(); ++k) {
    const Eigen::Isometry3d& X = object.X_WO[std::clamp(k, object.begin, object.end - 1)];
    Posture& posture = poses.postures.emplace_back();
    posture.position = X.translation();
    posture.orientation = Eigen::Quaterniond(X.linear());
    posture.joint_angles.resize(0);
  }
  return poses;
}

std::string ModelPathOf(const RecordedObject& object, const std::string& output) {
  const std::string model = NamedModel(object);
  return model.empty() ? object.recorded.model_path : ModelPathFor(model, output);
}

}  // namespace mmm_converter
