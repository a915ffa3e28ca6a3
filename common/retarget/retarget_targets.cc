// SPDX-License-Identifier: MIT
#include "common/retarget/retarget_targets.h"

#include <functional>
#include <utility>

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
constexpr int kWholeArm = 3;      // joints before the elbow that point a forearm anywhere
constexpr double kPoorArm = 0.2;  // direction of arms with fewer, which would drag the trunk
constexpr double kHandTurn = 0.3;
constexpr double kHoldPlace = 0.003;  // of a hand at what it holds
constexpr double kHoldTurn = 0.1;
constexpr double kHeld = 1e-4;  // of a root without legs

using Target = std::function<Vector3d(const BodyPosture&, double)>;

/// Collects what follows the person.
class PersonAims {
 public:
  explicit PersonAims(const RobotBody& body)
      : weights_(body.weights), has_feet_(body.feet), R_WA_(body.map.R_WA) {}

  const AimWeights& weights() const { return weights_; }

  void Add(int segment, bool is_direction, const Vector3d& local, double deviation, Target target) {
    aims_.push_back({segment, is_direction, local, deviation, std::move(target)});
  }

  /// Directions of a segment's axes R_SX that are those of the person's. rotation(posture) has
  /// them.
  template <typename Rotation>
  void Turn(int segment, const Eigen::Matrix3d& R_SX, int column, double deviation,
            Rotation rotation) {
    const auto of_person = [=](const BodyPosture& person, double) -> Vector3d {
      return rotation(person).col(column);
    };
    // A robot that stands still: the person's chest faces as its own.
    const auto facing = [=, R_WA = R_WA_](const BodyPosture& person, double) -> Vector3d {
      return R_WA * person.R_chest.transpose() * rotation(person).col(column);
    };
    Add(segment, true, R_SX.col(column), deviation, has_feet_ ? Target(of_person) : Target(facing));
  }

  std::vector<PersonAim> Take() { return std::move(aims_); }

 private:
  AimWeights weights_;
  bool has_feet_;
  Eigen::Matrix3d R_WA_;
  std::vector<PersonAim> aims_;
};

void AddArms(const BodyMap& map, PersonAims* aims) {
  for (std::size_t i = 0; i < 2; ++i) {
    if (!map.arms[i]) continue;
    const LimbMap& arm = *map.arms[i];
    const double limbs = aims->weights().limbs;
    const double direction = Weighed(arm.fold < kWholeArm ? kPoorArm : kArmDirection, limbs);
    const double hand = Weighed(kHandTurn, aims->weights().hands);
    const auto upper = [i](const BodyPosture& p) { return p.arms[i].R_upper; };
    const auto lower = [i](const BodyPosture& p) { return p.arms[i].R_lower; };
    const auto end = [i](const BodyPosture& p) { return p.arms[i].R_end; };
    aims->Turn(arm.upper.segment, arm.upper.R_SL, 2, direction, upper);
    aims->Turn(arm.upper.segment, arm.upper.R_SL, 1, Weighed(kArmTwist, limbs), upper);
    aims->Turn(arm.lower.segment, arm.lower.R_SL, 2, direction, lower);
    if (!arm.has_wrist) continue;
    aims->Turn(arm.end, arm.R_ED, 2, hand, end);
    aims->Turn(arm.end, arm.R_ED, 1, hand, end);
  }
}

void AddLegs(const BodyMap& map, PersonAims* aims) {
  const double direction = Weighed(kLegDirection, aims->weights().limbs);
  const double twist = Weighed(kLegTwist, aims->weights().limbs);
  for (std::size_t i = 0; i < 2; ++i) {
    const LimbMap& leg = *map.legs[i];
    const auto upper = [i](const BodyPosture& p) { return p.legs[i].R_upper; };
    const auto lower = [i](const BodyPosture& p) { return p.legs[i].R_lower; };
    aims->Turn(leg.upper.segment, leg.upper.R_SL, 2, direction, upper);
    aims->Turn(leg.upper.segment, leg.upper.R_SL, 1, twist, upper);
    aims->Turn(leg.lower.segment, leg.lower.R_SL, 2, direction, lower);
  }
}

/// Of a robot without legs, wherever it is mounted.
void HoldRoot(const KinematicModel& model, const Vector3d& base, PersonAims* aims) {
  const Posture zero = ZeroPosture(model);
  aims->Add(0, false, Vector3d::Zero(), kHeld, [base](const BodyPosture&, double) { return base; });
  for (const int axis : {0, 2}) {
    aims->Add(0, true, Vector3d::Unit(axis), kHeld,
              [d = Vector3d(zero.orientation * Vector3d::Unit(axis))](const BodyPosture&, double) {
                return d;
              });
  }
}

/// Between the hips, in the pelvis.
Vector3d MidHip(const KinematicModel& model, const BodyMap& map) {
  const auto X_WS = SegmentPoses(model, ZeroPosture(model));
  return X_WS[map.pelvis].inverse() * PostureOfBody(map, X_WS).mid_hip;
}

/// Hands that hold an object are where the person's are, in a world as much smaller as the robot.
void AddHolds(const Retargeted& retargeted, const RobotBody& body, TrajectoryProblem* problem) {
  const int frames = problem->num_frames;
  const Vector3d floor = FloorOf(retargeted) * Vector3d::UnitZ();
  const double place = Weighed(kHoldPlace, body.weights.hands);
  const double turn = Weighed(kHoldTurn, body.weights.hands);
  for (std::size_t i = 0; i < 2; ++i) {
    if (!body.map.arms[i]) continue;
    const LimbMap& map = *body.map.arms[i];
    const std::vector<double> weights = WeightsOfHold(retargeted.holds, i, problem->rate, frames);
    std::vector<Aim> aims = {MakeAim({map.end, false, body.palms[i].p_S, place, {}}, frames)};
    for (const int column : {2, 1}) {
      if (map.has_wrist)
        aims.push_back(MakeAim({map.end, true, map.R_ED.col(column), turn, {}}, frames));
    }
    for (int k = 0; k < frames; ++k) {
      const LimbPosture& arm = retargeted.human.bodies[k].arms[i];
      aims[0].target.col(k) = retargeted.scale * (PalmOf(arm) - floor);
      if (map.has_wrist) aims[1].target.col(k) = arm.R_end.col(2);
      if (map.has_wrist) aims[2].target.col(k) = arm.R_end.col(1);
      for (Aim& aim : aims) aim.weight.col(k) *= weights[k];
    }
    problem->aims.insert(problem->aims.end(), aims.begin(), aims.end());
  }
}

}  // namespace

std::vector<PersonAim> AimsAtPerson(const Robot& robot, const RobotBody& body, double scale) {
  const BodyMap& map = body.map;
  PersonAims aims(body);
  for (const int column : {0, 2}) {
    aims.Turn(map.chest, map.R_CA, column, Weighed(kChestTurn, body.weights.trunk),
              [](const BodyPosture& p) { return p.R_chest; });
  }
  AddArms(map, &aims);
  if (!body.feet) {
    HoldRoot(robot.model, body.base, &aims);
    return aims.Take();
  }
  for (const int column : {0, 2}) {
    aims.Turn(map.pelvis, map.R_PA, column, Weighed(kPelvisTurn, body.weights.trunk),
              [](const BodyPosture& p) { return p.R_pelvis; });
  }
  aims.Add(map.pelvis, false, MidHip(robot.model, map), Weighed(kPelvisPlace, body.weights.trunk),
           [scale](const BodyPosture& person, double floor) -> Vector3d {
             return scale * (person.mid_hip - floor * Vector3d::UnitZ());
           });
  AddLegs(map, &aims);
  return aims.Take();
}

Aim MakeAim(const PersonAim& of, int frames) {
  return {of.segment, of.is_direction, of.local, Eigen::Matrix3Xd::Zero(3, frames),
          Eigen::Matrix3Xd::Constant(3, frames, 1 / of.deviation)};
}

FootDeviations Weighed(const FootDeviations& deviations, double weight) {
  return {Weighed(deviations.stance_place, weight), Weighed(deviations.stance_turn, weight),
          Weighed(deviations.swing_place, weight), Weighed(deviations.swing_turn, weight),
          Weighed(deviations.leaning, weight)};
}

std::array<Aim, 3> MakeFootAims(const RobotFoot& foot, int frames) {
  const Eigen::Matrix3Xd nothing = Eigen::Matrix3Xd::Zero(3, frames);
  return {{{foot.segment, false, foot.sole, nothing, nothing},
           {foot.segment, true, foot.R_FA.col(0), nothing, nothing},
           {foot.segment, true, foot.R_FA.col(1), nothing, nothing}}};
}

void SetFootAims(const RobotFoot& foot, const Eigen::Isometry3d& X_WF, bool stands,
                 const FootDeviations& deviations, int frame, Aim* aims) {
  const double place = stands ? deviations.stance_place : deviations.swing_place;
  const double turn = stands ? deviations.stance_turn : deviations.swing_turn;
  for (int i = 0; i < 3; ++i) {
    aims[i].target.col(frame) = i == 0 ? X_WF * aims[i].local : X_WF.linear() * aims[i].local;
    aims[i].weight.col(frame).setConstant(1 / (i == 0                  ? place
                                               : i == 2 && !foot.rolls ? deviations.leaning
                                                                       : turn));
  }
}

TrajectoryProblem EmptyProblem(const Robot& robot, const RobotBody& body, double rate, int frames) {
  TrajectoryProblem problem;
  problem.model = &robot.model;
  problem.rate = rate;
  problem.num_frames = frames;
  problem.velocity_limits = robot.velocity_limits;
  problem.rest = body.rest;
  problem.held = body.held;
  problem.capsules = &body.capsules;
  if (!body.feet) return problem;
  for (const RobotFoot& foot : *body.feet) {
    problem.balls.insert(problem.balls.end(), foot.balls.begin(), foot.balls.end());
  }
  problem.balls.insert(problem.balls.end(), body.balls.begin(), body.balls.end());
  return problem;
}

TrajectoryProblem MakeProblem(const Retargeted& retargeted, const Robot& robot,
                              const RobotBody& body, const FootTracks& feet,
                              const FootDeviations& deviations) {
  const int frames = retargeted.human.num_frames();
  TrajectoryProblem problem = EmptyProblem(robot, body, retargeted.human.rate, frames);
  const double floor = FloorOf(retargeted);
  for (const PersonAim& one : AimsAtPerson(robot, body, retargeted.scale)) {
    Aim& aim = problem.aims.emplace_back(MakeAim(one, frames));
    for (int k = 0; k < frames; ++k) {
      aim.target.col(k) = one.target(retargeted.human.bodies[k], floor);
    }
  }
  const FootDeviations weighed = Weighed(deviations, body.weights.feet);
  for (std::size_t i = 0; i < feet.size() && body.feet; ++i) {
    const RobotFoot& foot = (*body.feet)[i];
    auto aims = MakeFootAims(foot, frames);
    for (int k = 0; k < frames; ++k) {
      SetFootAims(foot, feet[i].X_WF[k], feet[i].stands[k], weighed, k, aims.data());
    }
    problem.aims.insert(problem.aims.end(), aims.begin(), aims.end());
  }
  if (!retargeted.holds.empty()) AddHolds(retargeted, body, &problem);
  return problem;
}

Posture FirstPosture(const BodyPosture& person, double scale, const Robot& robot,
                     const RobotBody& body) {
  Posture posture = ZeroPosture(robot.model);
  if (!body.feet) posture.position = body.base;
  if (!body.feet || robot.model.is_root_fixed()) return posture;
  const Vector3d forward = person.R_pelvis.col(0);
  const Vector3d zero = body.map.R_WA.col(0);
  const double yaw = std::atan2(forward.y(), forward.x()) - std::atan2(zero.y(), zero.x());
  posture.orientation = Eigen::AngleAxisd(yaw, Vector3d::UnitZ()) * posture.orientation;
  const auto X_WS = SegmentPoses(robot.model, posture);
  posture.position += scale * person.mid_hip - PostureOfBody(body.map, X_WS).mid_hip;
  return posture;
}

}  // namespace mmm_converter
