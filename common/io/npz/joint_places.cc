// SPDX-License-Identifier: MIT
#include "common/io/npz/joint_places.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string_view>
#include <utility>

#include "common/io/npz/smpl_model.h"
#include "common/io/skeleton/skeleton_body.h"
#include "common/io/skeleton/skeleton_content.h"
#include "common/math/statistics.h"
#include "common/motion/skeleton.h"
#include "common/support/error.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

using Eigen::Matrix3d;
using Eigen::Matrix3Xd;

using Layout = std::array<SmplJoint, kSmplJoints>;

// Of SMPL with and without hands, feet and face, in the layers of smplx and of data sets.
constexpr std::size_t kCounts[] = {22, 24, 25, 45, 52, 54, 55, 73, 127, 144};
constexpr int kSampledFrames = 50;
// Of limbs: Kinect's, OpenPose's and Human3.6M's orders have 3 and more, SMPL's and LAFAN1's none.
constexpr int kMostStrangeLimbs = 3;

constexpr Layout kLafan = {
    {{"Hips", -1},         {"LeftUpLeg", 0},  {"LeftLeg", 1},        {"LeftFoot", 2},
     {"LeftToe", 3},       {"RightUpLeg", 0}, {"RightLeg", 5},       {"RightFoot", 6},
     {"RightToe", 7},      {"Spine", 0},      {"Spine1", 9},         {"Spine2", 10},
     {"Neck", 11},         {"Head", 12},      {"LeftShoulder", 11},  {"LeftArm", 14},
     {"LeftForeArm", 15},  {"LeftHand", 16},  {"RightShoulder", 11}, {"RightArm", 18},
     {"RightForeArm", 19}, {"RightHand", 20}}};

SkeletonMotion MotionOf(const Layout& layout, const std::shared_ptr<const NumpyArray>& places) {
  SkeletonMotion motion;
  for (const SmplJoint& joint : layout) {
    motion.names.emplace_back(joint.name);
    motion.parents.push_back(joint.parent);
  }
  motion.has_orientations = false;
  motion.num_frames = static_cast<int>(places->rows());
  motion.pose = [places](int frame, Matrix3Xd* p, std::vector<Matrix3d>* R) {
    p->resize(3, kSmplJoints);
    R->resize(kSmplJoints, Matrix3d::Identity());
    for (int i = 0; i < 3 * kSmplJoints; ++i) {
      const double value =
          places->Number(static_cast<std::size_t>(frame), static_cast<std::size_t>(i));
      (*p)(i % 3, i / 3) = std::abs(value) < kFarthestJoint ? value : kNaN;
    }
    if (!p->allFinite()) p->setConstant(kNaN);
  };
  return motion;
}

/// How little a layout's bones are those of a body.
struct Strangeness {
  double sum = 0;  ///< how much they change over the motion, and left and right differ, by lengths
  int limbs = 0;   ///< bones of limbs that do so by far
};

bool IsOfLimb(std::string_view name) {
  constexpr std::string_view kEnds[] = {"Knee", "Ankle", "Elbow",   "Wrist",
                                        "Leg",  "Foot",  "ForeArm", "Hand"};
  return name != "L_Foot" && name != "R_Foot" && !name.ends_with("UpLeg") &&
         std::any_of(std::begin(kEnds), std::end(kEnds),
                     [&](std::string_view end) { return name.ends_with(end); });
}

Strangeness StrangenessOf(const SkeletonMotion& motion) {
  // Noise of 3 cm changes a thigh by a quarter.
  constexpr double kChange = 0.5, kDifference = 0.3;
  std::vector<std::vector<double>> lengths(kSmplJoints);
  Matrix3Xd p;
  std::vector<Matrix3d> R;
  for (const int k : SpreadFrames(motion.num_frames, kSampledFrames)) {
    motion.pose(k, &p, &R);
    if (!p.allFinite()) continue;
    for (std::size_t j = 1; j < lengths.size(); ++j) {
      lengths[j].push_back((p.col(static_cast<Eigen::Index>(j)) - p.col(motion.parents[j])).norm());
    }
  }
  Strangeness strangeness;
  if (lengths.back().empty()) return strangeness;
  std::vector<bool> is_strange(kSmplJoints, false);
  for (std::size_t j = 1; j < lengths.size(); ++j) {
    const double median = Median(lengths[j]);
    const auto [least, most] = std::minmax_element(lengths[j].begin(), lengths[j].end());
    strangeness.sum += (*most - *least) / (median + 1e-9);
    std::string other = motion.names[j];
    for (const auto& [left, right] : {std::pair("L_", "R_"), std::pair("Left", "Right")}) {
      if (other.starts_with(left)) other = right + other.substr(std::string(left).size());
    }
    const auto found = std::find(motion.names.begin(), motion.names.end(), other);
    const auto at = static_cast<std::size_t>(found - motion.names.begin());
    const double of_other = Median(lengths[at]);
    strangeness.sum += std::abs(median - of_other) / (median + of_other + 1e-9);
    const double change = Percentile(lengths[j], 90) - Percentile(lengths[j], 10);
    if (change > kChange * median) is_strange[j] = true;
    if (std::abs(median - of_other) > kDifference * (median + of_other) / 2) {
      is_strange[j] = is_strange[at] = true;
    }
  }
  for (std::size_t j = 1; j < lengths.size(); ++j) {
    if (is_strange[j] && IsOfLimb(motion.names[j])) ++strangeness.limbs;
  }
  return strangeness;
}

}  // namespace

RecordingContent ContentOfPlaces(NumpyArray places, double rate, const std::string& file,
                                 Warnings* warnings) {
  const std::vector<std::size_t>& shape = places.head().shape;
  const bool is_right =
      !places.head().is_text() && shape.size() == 3 && shape[0] > 0 && shape[2] == 3 &&
      std::find(std::begin(kCounts), std::end(kCounts), shape[1]) != std::end(kCounts);
  if (!is_right) {
    const bool is_features = shape.size() == 2 && (shape[1] == 263 || shape[1] == 251);
    throw Error(
        fmt::format("{}: has the shape {}{}; expected places of SMPL's or LAFAN1's joints: frames "
                    "x {} x 3",
                    file, ShapeText(places.head()),
                    is_features ? ", as features of HumanML3D or KIT-ML, whose joints are in the "
                                  "folder new_joints"
                                : "",
                    fmt::join(kCounts, ", ")));
  }
  const bool can_be_lafan = shape[1] == kLafan.size();
  const auto shared = std::make_shared<const NumpyArray>(std::move(places));
  SkeletonMotion motion = MotionOf(SmplJoints(), shared);
  Strangeness strangeness = StrangenessOf(motion);
  if (can_be_lafan) {
    SkeletonMotion lafan = MotionOf(kLafan, shared);
    const Strangeness of_lafan = StrangenessOf(lafan);
    if (of_lafan.sum < strangeness.sum) {
      motion = std::move(lafan);
      strangeness = of_lafan;
    }
  }
  if (strangeness.limbs >= kMostStrangeLimbs) {
    throw Error(fmt::format(
        "{}: its joints are in another order than SMPL's or LAFAN1's: so taken, {} of "
        "the bones of both arms and legs change their length or are longer on one side; "
        "put them into that order (pelvis, L_Hip, R_Hip, Spine1, L_Knee, ...)",
        file, strangeness.limbs));
  }
  motion.rate = rate;
  return ContentOfSkeleton(std::move(motion), "joint places", file, {}, warnings);
}

}  // namespace mmm_converter
