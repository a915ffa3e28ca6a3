// SPDX-License-Identifier: MIT
#include "common/study/limb_places.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "common/math/statistics.h"
#include "common/model/forward_kinematics.h"

namespace mmm_converter {
namespace {

using Eigen::Vector3d;

constexpr int kMostFrames = 40;
constexpr double kMostAtEnd = 0.5;     // of the frames
constexpr double kUprightTrunk = 0.5;  // cosine of 60 degrees
// The height of the ankle above the hip, in lengths of the trunk: who sits with straight legs has
// 0.
constexpr double kBesideTrunk = 0.2;
// The same of a leg that few labels show: on an arm that hangs down, feet are at the hips.
constexpr double kBesideTrunkOfFew = -0.2;
constexpr std::size_t kFewLabels = 3;
constexpr double kAtEnd = 0.035;  // [rad] from the end of a joint's range: 2 degrees

class LimbPlaces {
 public:
  LimbPlaces(const TrackingSetup& setup, const PoseTrajectory& trajectory,
             const Eigen::MatrixXd& residuals)
      : setup_(setup), model_(*setup.model), residuals_(residuals) {
    const auto& postures = trajectory.postures;
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
    if (static_cast<double>(at_end) < kMostAtEnd * static_cast<double>(angles_.size())) return 0;
    std::vector<double> distances;
    for (std::size_t m = 0; m < setup_.assignments().size(); ++m) {
      const auto row = static_cast<Eigen::Index>(m);
      if (!model_.IsBelow(model_.markers()[setup_.assignments()[m].marker].segment,
                          model_.joint_segment(joint))) {
        continue;
      }
      for (Eigen::Index k = 0; k < residuals_.cols(); ++k) {
        const double distance = residuals_(row, k);
        if (std::isfinite(distance)) distances.push_back(distance);
      }
    }
    return distances.empty() ? 0 : Median(distances);
  }

 private:
  int Segment(char side, const char* name) const {
    return model_.FindSegment(side + std::string(name));
  }

  const TrackingSetup& setup_;
  const KinematicModel& model_;
  const Eigen::MatrixXd& residuals_;
  std::vector<std::vector<Eigen::Isometry3d>> poses_;  ///< of segments, by frame
  std::vector<Eigen::VectorXd> angles_;                ///< of all joints, by frame
};

}  // namespace

std::vector<LimbPlace> MeasureLimbPlaces(const TrackingSetup& setup, const std::vector<Limb>& limbs,
                                         const MarkerSequence& markers,
                                         const PoseTrajectory& trajectory,
                                         const Eigen::MatrixXd& residuals) {
  std::vector<LimbPlace> measured;
  if (limbs.empty()) return measured;
  const LimbPlaces places(setup, trajectory, residuals);
  for (const Limb& limb : limbs) {
    if (limb.labels.empty()) continue;
    const char side = limb.name.starts_with("left") ? 'L' : 'R';
    const bool is_leg = limb.name.ends_with(" leg");
    if (!is_leg && !limb.name.ends_with(" arm")) continue;
    LimbPlace& place = measured.emplace_back();
    place.limb = limb.name;
    place.is_leg = is_leg;
    for (const LabelIx label : limb.labels) place.labels.push_back(markers.labels()[label]);
    if (is_leg) place.beside_trunk = places.BesideTrunk(side, limb.labels.size());
    place.bent_back = places.BentBackwards(side, is_leg ? "Kx_joint" : "Ex_joint");
  }
  return measured;
}

}  // namespace mmm_converter
