// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "common/io/skeleton/bone_names.h"
#include "common/motion/skeleton.h"

namespace mmm_converter {

/// Joints of a skeleton that are a body's; labels are the indices of joints, and there are no
/// points yet.
struct FoundBody {
  std::vector<SkeletonJoint> joints;  ///< none: it has neither two legs nor two arms alone
  double leg_length = 0;  ///< hip to ankle along the bones, or as its arms tell [file unit]
  bool has_exchanged_sides = false;  ///< left and right were named for right and left
  bool is_by_lengths = false;        ///< names told no two legs
};

/// Which joints are whose: feet and hands by their names, what is above them by kinds of names and,
/// where these don't tell, by the chain; pelvis and thorax are where legs and arms meet. Sides are
/// those that the names say, unless knees and toes show all over the motion that the body has them
/// the other way round. Where names tell no two legs, the longest two limbs that are alike are
/// legs, if knees and toes tell their sides, and the longest of the others arms. Two arms that
/// names tell are an upper body where there are no other limbs.
FoundBody FindBody(const SkeletonMotion& motion, const BoneNames& names);

/// Frames of a motion, spread evenly, at most so many.
std::vector<int> SpreadFrames(int num_frames, int most);

}  // namespace mmm_converter
