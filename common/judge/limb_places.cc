// SPDX-License-Identifier: MIT
#include "common/judge/limb_places.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "common/math/statistics.h"
#include "common/model/forward_kinematics.h"
#include "common/support/text.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

using Eigen::Vector3d;

constexpr int kMostFrames = 40;
constexpr double kMostOfThem = 0.5;
constexpr double kUprightTrunk = 0.5;  // cosine of 60 degrees
// Of the ankle above the hip, over the length of the trunk: who sits with straight legs has 0.
constexpr double kBesideTrunk = 0.2;
// The same of a leg that few labels show: on an arm that hangs down, feet are at the hips.
constexpr double kBesideTrunkOfFew = -0.2;
constexpr std::size_t kFewLabels = 3;
constexpr double kAtEnd = 0.035;  // [rad] from the end of a joint's range: 2 degrees
// Of the labels that a knee or elbow moves, on average: right at most 0.05.
constexpr double kFarBelow = 0.08;  // [m]

class LimbPlaces {
 public:
  LimbPlaces(const TrackingSetup& setup, const MarkerSequence& markers,
             const ConversionResult& result)
      : setup_(setup), model_(*setup.model), markers_(markers), result_(result) {
    const auto& postures = result.trajectory.postures;
    const auto all = static_cast<int>(postures.size());
    const int count = std::min(all, kMostFrames);
    for (int i = 0; i < count; ++i) {
      const Posture& tracked =
          postures[static_cast<std::size_t>(static_cast<long>(i) * all / count)];
      Posture posture = tracked;
      posture.joint_angles = RestAngles(model_);
      for (std::size_t j = 0; j < setup.joints.size(); ++j) {
        posture.joint_angles[setup.joints[j]] = tracked.joint_angles[static_cast<Eigen::Index>(j)];
      }
      poses_.push_back(SegmentPoses(model_, posture));
      angles_.push_back(std::move(posture.joint_angles));
    }
  }

  /// Share of the frames in which the trunk is upright and the leg beside it. side: 'L' or 'R'.
  double BesideTrunk(char side, std::size_t labels) const {
    const int hip = Segment(side, "Hx_joint"), ankle = Segment(side, "Ax_joint");
    const int neck = model_.FindSegment("BLNx_joint");
    if (hip < 0 || ankle < 0 || neck < 0 || poses_.empty()) return 0;
    const double least = labels <= kFewLabels ? kBesideTrunkOfFew : kBesideTrunk;
    const auto beside = std::count_if(poses_.begin(), poses_.end(), [&](const auto& poses) {
      const auto at = [&](int segment) -> Vector3d {
        return poses[static_cast<std::size_t>(segment)].translation();
      };
      const Vector3d trunk = at(neck) - at(0);
      const bool is_upright = trunk.z() > kUprightTrunk * trunk.norm();
      return is_upright && (at(ankle) - at(hip)).dot(trunk) > least * trunk.squaredNorm();
    });
    return static_cast<double>(beside) / static_cast<double>(poses_.size());
  }

  /// How far the labels are that the joint moves [m]; 0 where it is not at its straight end.
  double BentBackwards(char side, const char* name) const {
    const int joint = model_.FindJoint(side + std::string(name));
    if (joint < 0 || std::count(setup_.joints.begin(), setup_.joints.end(), joint) == 0) return 0;
    const auto& segment = model_.joint(joint);
    const double straight =
        std::abs(segment.lower) < std::abs(segment.upper) ? segment.lower : segment.upper;
    const auto at_end = std::count_if(angles_.begin(), angles_.end(), [&](const auto& angles) {
      return std::abs(angles[joint] - straight) < kAtEnd;
    });
    if (static_cast<double>(at_end) < kMostOfThem * static_cast<double>(angles_.size())) return 0;
    std::vector<double> distances;
    for (std::size_t m = 0; m < setup_.assignments().size(); ++m) {
      const auto row = static_cast<Eigen::Index>(m);
      if (!IsBelow(model_.markers()[setup_.assignments()[m].marker].segment,
                   model_.joint_segment(joint))) {
        continue;
      }
      for (Eigen::Index k = 0; k < result_.residuals.cols(); ++k) {
        const double distance = result_.residuals(row, k);
        if (std::isfinite(distance)) distances.push_back(distance);
      }
    }
    return distances.empty() ? 0 : Median(distances);
  }

  std::string LabelsOf(const Limb& limb) const {
    std::vector<std::string> names;
    for (const LabelIx label : limb.labels) names.push_back(markers_.labels()[label]);
    return FirstNames(names, 6);
  }

 private:
  int Segment(char side, const char* name) const {
    return model_.FindSegment(side + std::string(name));
  }
  bool IsBelow(int segment, int joint_segment) const {
    while (segment > joint_segment) segment = model_.segments()[segment].parent;
    return segment == joint_segment;
  }

  const TrackingSetup& setup_;
  const KinematicModel& model_;
  const MarkerSequence& markers_;
  const ConversionResult& result_;
  std::vector<std::vector<Eigen::Isometry3d>> poses_;  ///< of segments, by frame
  std::vector<Eigen::VectorXd> angles_;                ///< of all joints, by frame
};

}  // namespace

void JudgeLimbPlaces(const TrackingSetup& setup, const std::vector<Limb>& limbs,
                     const MarkerSequence& markers, const ConversionResult& result,
                     VerdictReasons* reasons) {
  if (limbs.empty()) return;
  const LimbPlaces places(setup, markers, result);
  for (const Limb& limb : limbs) {
    if (limb.labels.empty()) continue;
    const char side = limb.name.starts_with("left") ? 'L' : 'R';
    const bool is_leg = limb.name.ends_with(" leg");
    if (!is_leg && !limb.name.ends_with(" arm")) continue;
    const double beside = is_leg ? places.BesideTrunk(side, limb.labels.size()) : 0;
    if (beside > kMostOfThem) {
      reasons->Add(Verdict::Level::kCheck,
                   fmt::format("the {} lies beside the trunk, where a leg can't be for long, in "
                               "{:.0f} % of the frames: are its labels another limb's ({})?",
                               limb.name, kPercent * beside, places.LabelsOf(limb)));
    }
    const double far = places.BentBackwards(side, is_leg ? "Kx_joint" : "Ex_joint");
    if (far > kFarBelow) {
      reasons->Add(Verdict::Level::kCheck,
                   fmt::format("the {} would bend backwards at the {}: straight, its labels are "
                               "{:.0f} mm from the model ({})",
                               limb.name, is_leg ? "knee" : "elbow", kMillimetres * far,
                               places.LabelsOf(limb)));
    }
  }
}

}  // namespace mmm_converter
