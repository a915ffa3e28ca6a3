// SPDX-License-Identifier: MIT
#include "common/retarget/retarget.h"

#include <fmt/format.h>

#include <utility>

#include "common/model/forward_kinematics.h"
#include "common/motion/slow_feet.h"
#include "common/retarget/belt.h"
#include "common/retarget/held_joints.h"
#include "common/retarget/retarget_targets.h"
#include "common/support/error.h"

namespace mmm_converter {
namespace {

constexpr int kFewestFrames = 3;
constexpr FitEffort kFirstEffort = {3, 18, 0.05, false};
constexpr FitEffort kLastEffort = {5, 40, 0.02, true};
constexpr FootDeviations kSoft = {0.006, 0.03, 0.006, 0.1};
// What a foot may go between two frames at 200 Hz and still stand; a turn moves its ends, 0.2 m
// away.
constexpr FootDeviations kFirm = {0.00005, 0.00025, 0.006, 0.1};

FootTracks FeetOf(const KinematicModel& model, const RobotBody& body,
                  const std::vector<Posture>& postures, FootTracks tracks) {
  for (std::size_t k = 0; k < postures.size(); ++k) {
    const auto X_WS = SegmentPoses(model, postures[k]);
    for (std::size_t i = 0; i < 2; ++i) tracks[i].X_WF[k] = X_WS[(*body.feet)[i].segment];
  }
  return tracks;
}

void TakeObjects(const std::vector<TrackedObject>& objects, const RobotBody& body,
                 Retargeted* result) {
  if (objects.empty()) return;
  if (!body.feet) {
    throw Error("objects keep their place to the hands of a robot with legs; this one has none");
  }
  result->holds = FindHolds(result->human, objects);
  for (const TrackedObject& object : objects) {
    result->objects.push_back(ScaledObject(object, result->scale, FloorOf(*result)));
  }
}

}  // namespace

Eigen::Vector3d WayOfBelt(const Retargeted& retargeted, int k) {
  return retargeted.scale * k / retargeted.motion.rate * retargeted.belt;
}

double FloorOf(const Retargeted& retargeted) {
  double floor = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    floor += 0.5 * retargeted.states.heels[i].level;
  }
  return floor;
}

Retargeted DescribePerson(const KinematicModel& human_model, const PoseTrajectory& motion,
                          const Robot& robot, const RobotBody& body, const PersonsGround& ground) {
  const HumanBody person = FindHumanBody(human_model);
  const PoseTrajectory& recorded = ground.recorded != nullptr ? *ground.recorded : motion;
  Retargeted result;
  const FootMotion feet = MoveFeet(human_model, recorded);
  result.belt = (feet.feet[0].belt + feet.feet[1].belt) / 2;
  result.human = MoveHuman(human_model, person, motion);
  MoveAgainst(result.belt, &result.human);
  result.contacts = ground.contacts != nullptr ? *ground.contacts : FindSlowContacts(feet);
  result.states = FindFootStates(feet);
  result.rests = FindRests(feet, result.states, result.contacts);
  if (ground.recorded != nullptr) {
    result.states = AtRate(result.states, feet.rate, motion.rate, motion.num_frames());
    result.rests = AtRate(result.rests, result.states, feet.rate, motion.rate);
  }
  result.ankle_height = person.ankle_height;
  result.scale = body.size / (body.feet ? person.leg_length() : person.arm_length());
  result.motion.rate = motion.rate;
  result.motion.first_time = motion.first_time;
  for (int j = 0; j < robot.model.num_joints(); ++j) {
    result.motion.joint_names.push_back(robot.model.joint(j).name);
  }
  return result;
}

Retargeted RetargetMotion(const KinematicModel& human_model, const PoseTrajectory& motion,
                          const Robot& robot, const RobotBody& body,
                          const std::vector<TrackedObject>& objects, const PersonsGround& ground) {
  if (motion.num_frames() < kFewestFrames) {
    throw Error(fmt::format("a motion of {} frames; at least {} are brought to a robot",
                            motion.num_frames(), kFewestFrames));
  }
  Retargeted result = DescribePerson(human_model, motion, robot, body, ground);
  TakeObjects(objects, body, &result);
  FootTracks feet = ScaledFeet(result, body);
  TrajectoryProblem problem = MakeProblem(result, robot, body, feet, kSoft);
  std::vector<Posture> start = StartTrajectory(
      problem, FirstPosture(result.human.bodies.front(), result.scale, robot, body));
  FitResult fit = FitTrajectory(problem, std::move(start), body.feet ? kFirstEffort : kLastEffort);
  if (body.feet) {
    feet = AnchoredFeet(result, body, FeetOf(robot.model, body, fit.postures, feet));
    problem = MakeProblem(result, robot, body, feet, kFirm);
    fit = FitTrajectory(problem, std::move(fit.postures), kLastEffort);
  }
  for (Posture& posture : fit.postures) PutHeldJoints(body, &posture);
  result.iterations = fit.iterations;
  result.keeps_limits = fit.has_converged;
  result.motion.postures = std::move(fit.postures);
  for (int k = 0; k < motion.num_frames(); ++k) {
    result.motion.postures[static_cast<std::size_t>(k)].position += WayOfBelt(result, k);
  }
  return result;
}

}  // namespace mmm_converter
