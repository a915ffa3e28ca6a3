// SPDX-License-Identifier: MIT
#include "common/live/mvn/mvn_body.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "common/model/forward_kinematics.h"
#include "common/support/error.h"

namespace mmm_converter {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

enum class Side { kMiddle, kRightArm, kLeftArm };

struct MvnSegment {
  const char* segment = nullptr;
  Side side = Side::kMiddle;
  const char* toward = nullptr;
  double share = 0;
};

// In MVN's order: pelvis, L5, L3, T12, T8, neck, head; arms and legs, right before left.
constexpr std::array<MvnSegment, kMvnSegments> kSegments = {{
    {"root_joint"},
    {"BPy_joint"},
    {"BTy_joint"},
    {"BTy_joint", Side::kMiddle, "BLNy_joint", 1.0 / 3},
    {"BTy_joint", Side::kMiddle, "BLNy_joint", 2.0 / 3},
    {"BLNy_joint"},
    {"BUNy_joint"},
    {"RSCy_joint"},
    {"RSy_joint", Side::kRightArm},
    {"REz_joint", Side::kRightArm},
    {"RWy_joint", Side::kRightArm},
    {"LSCy_joint"},
    {"LSy_joint", Side::kLeftArm},
    {"LEz_joint", Side::kLeftArm},
    {"LWy_joint", Side::kLeftArm},
    {"RHy_joint"},
    {"RKx_joint"},
    {"RAy_joint"},
    {"RFx_joint"},
    {"LHy_joint"},
    {"LKx_joint"},
    {"LAy_joint"},
    {"LFx_joint"},
}};

int FindSegment(const KinematicModel& model, const std::string& name) {
  const auto& segments = model.segments();
  const auto found = std::find_if(segments.begin(), segments.end(),
                                  [&](const Segment& one) { return one.name == name; });
  if (found == segments.end()) {
    throw Error(
        fmt::format("the model has no segment {}: MVN's segments are those of a person, as MMM's "
                    "model has them",
                    name));
  }
  return static_cast<int>(found - segments.begin());
}

// MVN's axes in the world, of a person with MMM's zero posture: upright, looking along y, the arms
// hanging.
Quaterniond AxesAtZero(Side side) {
  Quaterniond forward(AngleAxisd(M_PI / 2, Vector3d::UnitZ()));
  if (side == Side::kMiddle) return forward;
  const double down = side == Side::kRightArm ? M_PI / 2 : -M_PI / 2;
  return forward * AngleAxisd(down, Vector3d::UnitX());
}

}  // namespace

MvnBody::MvnBody(const KinematicModel& model) {
  Posture zero = ZeroPosture(model);
  zero.joint_angles.setZero();
  const auto poses = SegmentPoses(model, zero);
  for (std::size_t i = 0; i < kSegments.size(); ++i) {
    const MvnSegment& segment = kSegments[i];
    Part& part = parts_[i];
    part.segment = FindSegment(model, segment.segment);
    if (segment.toward != nullptr) part.toward = FindSegment(model, segment.toward);
    part.share = segment.share;
    const Quaterniond R_WS(poses[static_cast<std::size_t>(part.segment)].linear());
    part.R_SA = R_WS.conjugate() * AxesAtZero(segment.side);
  }
}

MvnPoses MvnBody::Poses(const KinematicModel& model, const Posture& posture) const {
  const auto poses = SegmentPoses(model, posture);
  MvnPoses mvn;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const Part& part = parts_[i];
    const Eigen::Isometry3d& own = poses[static_cast<std::size_t>(part.segment)];
    mvn[i].setIdentity();
    mvn[i].linear() = own.linear() * part.R_SA.toRotationMatrix();
    mvn[i].translation() = own.translation();
    if (part.toward < 0) continue;
    const Vector3d way =
        poses[static_cast<std::size_t>(part.toward)].translation() - own.translation();
    mvn[i].translation() += part.share * way;
  }
  return mvn;
}

MvnPoses MvnBody::TPose(const KinematicModel& model) const {
  Posture posture = ZeroPosture(model);
  posture.joint_angles.setZero();
  for (const auto& [name, angle] : {std::pair("LSy_joint", M_PI / 2), {"RSy_joint", -M_PI / 2}}) {
    if (const int j = model.FindJoint(name); j >= 0) posture.joint_angles[j] = angle;
  }
  MvnPoses poses = Poses(model, posture);
  const Quaterniond to_x = AxesAtZero(Side::kMiddle).conjugate();
  const Vector3d pelvis = poses.front().translation();
  double lowest = pelvis.z();
  for (const auto& pose : poses) lowest = std::min(lowest, pose.translation().z());
  const Vector3d ground(pelvis.x(), pelvis.y(), lowest);
  for (auto& pose : poses) {
    const Vector3d place = to_x * (pose.translation() - ground);
    pose.setIdentity();
    pose.translation() = place;
  }
  return poses;
}

}  // namespace mmm_converter
