// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "common/io/mmm/mmm_motion.h"
#include "common/motion/pose_trajectory.h"
#include "common/retarget/held_objects.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// An object beside a person, as its file has it.
struct RecordedObject {
  std::string file;
  MmmMotion recorded;
};

/// The motions without joints of MMM files: "FILE" all, "FILE:A,B" those.
/// @throws Error where one is not there, or two are called alike.
std::vector<RecordedObject> ReadObjects(const std::vector<std::string>& texts);

/// The file of such a text.
std::string FileOfObjects(const std::string& text);

/// At the person's times: the longest part without a gap; a warning tells what is left out.
/// @throws Error where the times have nothing in common.
std::vector<TrackedObject> AlignObjects(const PoseTrajectory& person,
                                        const std::vector<RecordedObject>& objects,
                                        Warnings* warnings);

/// The frames in which it is known. frames: has their times.
PoseTrajectory PosesOf(const TrackedObject& object, const PoseTrajectory& frames);

/// All frames: where it is not known as in the nearest one in which it is.
PoseTrajectory PosesAlways(const TrackedObject& object, const PoseTrajectory& frames);

/// The file of the model that it names, which may give its size; empty: there is none.
std::string NamedModel(const RecordedObject& object);

/// To write into `output`.
std::string ModelPathOf(const RecordedObject& object, const std::string& output);

}  // namespace mmm_converter
