// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "common/motion/recording_content.h"
#include "common/motion/skeleton.h"
#include "common/support/warnings.h"

namespace mmm_converter {

struct BvhChannel {
  bool is_rotation = false;
  int axis = 0;  ///< 0, 1 or 2: x, y or z
};

struct BvhJoint {
  std::string name;  ///< of an End Site empty
  int parent = -1;   ///< before its children; -1: a root
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();
  std::vector<BvhChannel> channels;
  int first_channel = 0;  ///< of a frame's numbers
};

/// A BVH file (Biovision hierarchy), in its own unit and axes: a joint is placed by its OFFSET, of
/// which position channels replace the coordinates that they are of, and turned by its rotation
/// channels in the order in which they are listed, R = R1 R2 R3.
struct Bvh {
  std::vector<BvhJoint> joints;
  int num_channels = 0;
  double rate = 0;  ///< [Hz]; 0: the file does not say
  long declared_frames = 0;
  std::vector<double> numbers;  ///< frame by frame [file unit, degrees]; NaN: not known
  bool adds_root_offset = false;

  int num_frames() const {
    return num_channels == 0 ? 0 : static_cast<int>(numbers.size()) / num_channels;
  }
};

bool LooksLikeBvh(std::string_view content);

/// Frames are read as far as the file has them whole; one with something that is no number, or of
/// another length, is not known.
/// @throws Error with the line of what is wrong with the hierarchy, and where there is no frame.
Bvh ParseBvh(std::string_view content, const std::string& file, Warnings* warnings);

/// Positions and orientations of all joints in a frame.
void PoseBvh(const Bvh& bvh, int frame, Eigen::Matrix3Xd* p, std::vector<Eigen::Matrix3d>* R);

/// @throws Error as ReadFileContent and ParseBvh.
RecordingContent ReadBvhContent(const std::string& file, const ContentOptions& options,
                                Warnings* warnings);

}  // namespace mmm_converter
