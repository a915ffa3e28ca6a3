// SPDX-License-Identifier: MIT
#include "common/retarget/retarget_targets.h"

#include <algorithm>

#include "common/model/forward_kinematics.h"

namespace mmm_converter {
namespace {

using Eigen::Vector3d;

// Standard deviations [m], [rad].
constexpr double kPelvisPlace = 0.025;
constexpr double kPelvisTurn = 0.1;
constexpr double kChestTurn = 0.1;
constexpr double kLegDirection = 0.05;
constexpr double kLegTwist = 0.3;
constexpr double kArmDirection = 0.04;
constexpr double kArmTwist = 0.4;
constexpr double kHandTurn = 0.3;
constexpr double kHeld = 1e-4;    // of a root without legs
constexpr double kLeaning = 0.1;  // of a foot that no joint rolls

/// Collects aims frame by frame of a motion.
class AimsOf {
 public:
  AimsOf(const Retargeted& retargeted, const RobotBody& body, std::vector<Aim>* aims)
      : retargeted_(retargeted), body_(body), aims_(*aims) {}

  /// value(k): what it is to be in frame k.
  template <typename Value>
  void Add(int segment, bool is_direction, const Vector3d& local, double deviation, Value value) {
    const int frames = retargeted_.human.num_frames();
    Aim aim{segment, is_direction, local, Eigen::Matrix3Xd(3, frames),
            Eigen::Matrix3Xd::Constant(3, frames, 1 / deviation)};
    for (int k = 0; k < frames; ++k) aim.target.col(k) = value(k);
    aims_.push_back(std::move(aim));
  }

  /// Directions of a segment's axes R_SX that are those of the person's. rotation(posture) has
  /// them.
  template <typename Rotation>
  void Turn(int segment, const Eigen::Matrix3d& R_SX, int column, double deviation,
            Rotation rotation) {
    Add(segment, true, R_SX.col(column), deviation, [&](int k) -> Vector3d {
      return Facing(k) * rotation(retargeted_.human.bodies[k]).col(column);
    });
  }

  /// What brings the person's directions to a robot that stands still: its chest faces forward.
  Eigen::Matrix3d Facing(int k) const {
    if (body_.feet) return Eigen::Matrix3d::Identity();
    return body_.map.R_WA * retargeted_.human.bodies[k].R_chest.transpose();
  }

 private:
  const Retargeted& retargeted_;
  const RobotBody& body_;
  std::vector<Aim>& aims_;
};

void AddArms(const BodyMap& map, AimsOf* aims) {
  for (std::size_t i = 0; i < 2; ++i) {
    if (!map.arms[i]) continue;
    const LimbMap& arm = *map.arms[i];
    const auto upper = [i](const BodyPosture& p) { return p.arms[i].R_upper; };
    const auto lower = [i](const BodyPosture& p) { return p.arms[i].R_lower; };
    const auto end = [i](const BodyPosture& p) { return p.arms[i].R_end; };
    aims->Turn(arm.upper.segment, arm.upper.R_SL, 2, kArmDirection, upper);
    aims->Turn(arm.upper.segment, arm.upper.R_SL, 1, kArmTwist, upper);
    aims->Turn(arm.lower.segment, arm.lower.R_SL, 2, kArmDirection, lower);
    if (!arm.has_wrist) continue;
    aims->Turn(arm.end, arm.R_ED, 2, kHandTurn, end);
    aims->Turn(arm.end, arm.R_ED, 1, kHandTurn, end);
  }
}

void AddLegs(const BodyMap& map, AimsOf* aims) {
  for (std::size_t i = 0; i < 2; ++i) {
    const LimbMap& leg = *map.legs[i];
    const auto upper = [i](const BodyPosture& p) { return p.legs[i].R_upper; };
    const auto lower = [i](const BodyPosture& p) { return p.legs[i].R_lower; };
    aims->Turn(leg.upper.segment, leg.upper.R_SL, 2, kLegDirection, upper);
    aims->Turn(leg.upper.segment, leg.upper.R_SL, 1, kLegTwist, upper);
    aims->Turn(leg.lower.segment, leg.lower.R_SL, 2, kLegDirection, lower);
  }
}

void AddFoot(const RobotFoot& foot, const FootTrack& track, const FootDeviations& deviations,
             AimsOf* aims, std::vector<Aim>* list) {
  const auto weigh = [&](double stance, double swing) {
    for (Eigen::Index k = 0; k < list->back().weight.cols(); ++k) {
      list->back().weight.col(k).setConstant(1 / (track.stands[k] ? stance : swing));
    }
  };
  aims->Add(foot.segment, false, foot.sole, 1,
            [&](int k) -> Vector3d { return track.X_WF[k] * foot.sole; });
  weigh(deviations.stance_place, deviations.swing_place);
  for (const int column : {0, 1}) {
    const Vector3d axis = foot.R_FA.col(column);
    aims->Add(foot.segment, true, axis, 1,
              [&](int k) -> Vector3d { return track.X_WF[k].linear() * axis; });
    const bool is_free = column == 1 && !foot.rolls;
    weigh(is_free ? kLeaning : deviations.stance_turn, is_free ? kLeaning : deviations.swing_turn);
  }
}

/// Of a robot without legs, wherever it is mounted.
void HoldRoot(const KinematicModel& model, AimsOf* aims) {
  const Posture zero = ZeroPosture(model);
  aims->Add(0, false, Vector3d::Zero(), kHeld, [&](int) { return zero.position; });
  for (const int axis : {0, 2}) {
    aims->Add(0, true, Vector3d::Unit(axis), kHeld,
              [&](int) -> Vector3d { return zero.orientation * Vector3d::Unit(axis); });
  }
}

/// Between the hips, in the pelvis.
Vector3d MidHip(const KinematicModel& model, const BodyMap& map) {
  const auto X_WS = SegmentPoses(model, ZeroPosture(model));
  return X_WS[map.pelvis].inverse() * PostureOfBody(map, X_WS).mid_hip;
}

double FloorOf(const Retargeted& retargeted) {
  double floor = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    floor += 0.5 * (retargeted.states.heels[i].level - retargeted.heel_heights[i]);
  }
  return floor;
}

}  // namespace

TrajectoryProblem MakeProblem(const Retargeted& retargeted, const Robot& robot,
                              const RobotBody& body, const FootTracks& feet,
                              const FootDeviations& deviations) {
  TrajectoryProblem problem;
  problem.model = &robot.model;
  problem.rate = retargeted.human.rate;
  problem.num_frames = retargeted.human.num_frames();
  problem.velocity_limits = robot.velocity_limits;
  problem.rest = ZeroPosture(robot.model).joint_angles;
  const BodyMap& map = body.map;
  AimsOf aims(retargeted, body, &problem.aims);
  for (const int column : {0, 2}) {
    aims.Turn(map.chest, map.R_CA, column, kChestTurn,
              [](const BodyPosture& p) { return p.R_chest; });
  }
  AddArms(map, &aims);
  if (!body.feet) {
    HoldRoot(robot.model, &aims);
    return problem;
  }
  for (const int column : {0, 2}) {
    aims.Turn(map.pelvis, map.R_PA, column, kPelvisTurn,
              [](const BodyPosture& p) { return p.R_pelvis; });
  }
  const double floor = FloorOf(retargeted);
  aims.Add(map.pelvis, false, MidHip(robot.model, map), kPelvisPlace, [&](int k) -> Vector3d {
    return retargeted.scale * (retargeted.human.bodies[k].mid_hip - floor * Vector3d::UnitZ());
  });
  AddLegs(map, &aims);
  for (std::size_t i = 0; i < 2; ++i) {
    const RobotFoot& foot = (*body.feet)[i];
    AddFoot(foot, feet[i], deviations, &aims, &problem.aims);
    problem.balls.insert(problem.balls.end(), foot.balls.begin(), foot.balls.end());
  }
  return problem;
}

Posture FirstPosture(const Retargeted& retargeted, const Robot& robot, const RobotBody& body) {
  Posture posture = ZeroPosture(robot.model);
  if (robot.model.is_root_fixed()) return posture;
  const BodyPosture& person = retargeted.human.bodies.front();
  const Vector3d forward = person.R_pelvis.col(0);
  const Vector3d zero = body.map.R_WA.col(0);
  const double yaw = std::atan2(forward.y(), forward.x()) - std::atan2(zero.y(), zero.x());
  posture.orientation = Eigen::AngleAxisd(yaw, Vector3d::UnitZ()) * posture.orientation;
  const auto X_WS = SegmentPoses(robot.model, posture);
  posture.position += retargeted.scale * person.mid_hip - PostureOfBody(body.map, X_WS).mid_hip;
  return posture;
}

}  // namespace mmm_converter
