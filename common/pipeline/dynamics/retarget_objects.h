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
  TrackedObject motion;  ///< of the person's frames, by AlignObjects
};

/// The motions without joints of MMM files: "FILE" all, "FILE:A,B" those.
/// @throws Error where one is not there, or two are called alike.
std::vector<RecordedObject> ReadObjects(const std::vector<std::string>& texts);

/// The file of such a text.
std::string FileOfObjects(const std::string& text);

/// Files of models they name, which may give their sizes. Of what can't be read: none.
std::vector<std::string> ModelsOfObjects(const std::vector<std::string>& texts);

/// At the person's times: the longest part without a gap; a warning tells what is left out.
/// @throws Error where the times have nothing in common.
void AlignObjects(const PoseTrajectory& person, std::vector<RecordedObject>* objects,
                  Warnings* warnings);

/// The frames in which it is known. frames: has their times.
PoseTrajectory PosesOf(const TrackedObject& object, const PoseTrajectory& frames);

/// To write into `output`.
std::string ModelPathOf(const RecordedObject& object, const std::string& output);

}  // namespace mmm_converter
