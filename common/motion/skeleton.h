// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

namespace mmm_converter {

/// Poses of a skeleton's joints over time, in the file's own unit and axes.
struct SkeletonMotion {
  std::vector<std::string> names;  ///< of joints; of an end of a bone empty
  std::vector<int> parents;        ///< before their children; -1: none
  bool has_orientations = true;
  double rate = 0;  ///< [Hz]; 0: the file does not say
  int num_frames = 0;
  long declared_frames = 0;  ///< 0: the file does not say
  /// Positions (3 x joints; NaN: not known) and orientations of all joints in a frame. Without
  /// orientations R stays as it is.
  std::function<void(int frame, Eigen::Matrix3Xd* p, std::vector<Eigen::Matrix3d>* R)> pose;

  int num_joints() const { return static_cast<int>(names.size()); }
};

/// What a joint of a skeleton is of a body.
enum class BodyJoint {
  kPelvis,  ///< any place that moves with it
  kThorax,  ///< the same
  kNeck,    ///< between thorax and neck
  kHead,    ///< between neck and head
  kShoulder,
  kElbow,
  kWrist,
  kHip,
  kKnee,
  kAnkle,
  kToe,  ///< where toes begin or, of skeletons that end there, where they end
};

/// A joint of a body that a recording shows: its place is a label, and points that are fixed to the
/// bone which begins there are more of them, by which the bone's orientation is known.
struct SkeletonJoint {
  BodyJoint joint = BodyJoint::kPelvis;
  std::string side;         ///< "L" or "R"; of the middle empty
  int label = 0;            ///< of the recording
  std::vector<int> points;  ///< likewise; none: no orientation is known
};

}  // namespace mmm_converter
