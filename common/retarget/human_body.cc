// SPDX-License-Identifier: MIT
#include "common/retarget/human_body.h"

#include <fmt/format.h>

#include <initializer_list>
#include <string>

#include "common/model/coordinate_map.h"
#include "common/model/forward_kinematics.h"
#include "common/motion/foot_motion.h"
#include "common/motion/marker_synthesis.h"
#include "common/retarget/limb_geometry.h"
#include "common/support/error.h"

namespace mmm_converter {
namespace {

using Eigen::Vector3d;

/// Names of the right side; the first that the model has counts.
struct LimbNames {
  std::initializer_list<const char*> upper, lower, end;
};
const LimbNames kLeg = {
    {"RHy_joint", "femur_r"}, {"RKx_joint", "tibia_r"}, {"RAy_joint", "calcn_r", "foot_r"}};
const LimbNames kArm = {
    {"RSy_joint", "humerus_r"}, {"REx_joint", "ulna_r", "radius_r"}, {"RWy_joint", "hand_r"}};

int Find(const KinematicModel& model, std::initializer_list<const char*> names, bool is_left) {
  for (std::string name : names) {
    if (is_left && name.front() == 'R') name.front() = 'L';
    if (is_left && name.ends_with("_r")) name.back() = 'l';
    const int segment = model.FindSegment(name);
    if (segment >= 0) return segment;
  }
  throw Error(
      fmt::format("a motion is brought to a robot from a person of MMM's reference model "
                  "or of a model of OpenSim with arms and legs; the model {} has no {}",
                  model.name(), *names.begin()));
}

Eigen::Matrix3d StandingAxes(const KinematicModel& model) {
  Eigen::Matrix3d axes;
  if (model.coordinates()) {
    axes << Vector3d::UnitX(), -Vector3d::UnitZ(), Vector3d::UnitY();
    return model.coordinates()->R_WG() * axes;
  }
  axes << Vector3d::UnitY(), -Vector3d::UnitX(), Vector3d::UnitZ();
  return axes;
}

LimbMap MakeHumanLimb(const KinematicModel& model, const std::vector<Eigen::Isometry3d>& X_WS,
                      const LimbNames& names, bool is_left, const Vector3d& left) {
  const int upper = Find(model, names.upper, is_left), lower = Find(model, names.lower, is_left);
  LimbMap limb;
  limb.end = Find(model, names.end, is_left);
  limb.chain = {upper, lower, limb.end};
  limb.fold = 1;
  limb.beyond = 2;
  // OpenSim's calcn begins at the heel; what carries it begins at the ankle.
  const int distal =
      model.coordinates() && &names == &kLeg ? model.segments()[limb.end].parent : limb.end;
  const Vector3d proximal_W = X_WS[upper].translation(), middle_W = X_WS[lower].translation();
  const Vector3d distal_W = X_WS[distal].translation();
  limb.proximal = {upper, Vector3d::Zero()};
  limb.middle = {lower, Vector3d::Zero()};
  limb.distal = {lower, X_WS[lower].inverse() * distal_W};
  limb.upper = MakeLimbSegment(upper, X_WS[upper], proximal_W, middle_W, left);
  limb.lower = MakeLimbSegment(lower, X_WS[lower], middle_W, distal_W, left);
  limb.R_ED = X_WS[limb.end].linear().transpose() * X_WS[lower].linear() * limb.lower.R_SL;
  limb.has_wrist = true;
  return limb;
}

void FindFeet(const KinematicModel& model, const std::vector<Eigen::Isometry3d>& X_WS,
              const FootMotion& standing, HumanBody* body) {
  for (std::size_t i = 0; i < 2; ++i) {
    const int foot = body->map.legs[i]->end;
    body->R_FA[i] = X_WS[foot].linear().transpose() * body->map.R_WA;
    const std::string side = i == 0 ? "L" : "R";
    const auto place = [&](const std::string& name, const Eigen::Matrix3Xd& path) -> BodyPoint {
      for (const char* prefix : {"MARKER_", ""}) {
        const int marker = model.FindMarker(std::string(prefix).append(side).append(name));
        if (marker >= 0) return {model.markers()[marker].segment, model.markers()[marker].p_SM};
      }
      return {foot, X_WS[foot].inverse() * Vector3d(path.col(0))};
    };
    body->heels[i] = place("HEE", standing.feet[i].heel);
    body->toes[i] = place("TOE", standing.feet[i].toe);
    const Vector3d heel = X_WS[body->heels[i].segment] * body->heels[i].p_S;
    const Vector3d toe = X_WS[body->toes[i].segment] * body->toes[i].p_S;
    body->heel_heights[i] = heel.z() - standing.feet[i].heel(2, 0);
    body->toe_heights[i] = toe.z() - standing.feet[i].heel(2, 0);
  }
  const Vector3d ankle = X_WS[body->map.legs[0]->distal.segment] * body->map.legs[0]->distal.p_S;
  body->ankle_height = ankle.z() - standing.feet[0].heel(2, 0);
}

}  // namespace

Posture StandingPosture(const KinematicModel& model) {
  if (!model.coordinates()) return ZeroPosture(model);
  const auto count = static_cast<Eigen::Index>(model.coordinates()->coordinates().size());
  return PostureOf(model, Eigen::VectorXd::Zero(count));
}

HumanBody FindHumanBody(const KinematicModel& model) {
  const Posture posture = StandingPosture(model);
  const auto X_WS = SegmentPoses(model, posture);
  HumanBody body;
  BodyMap& map = body.map;
  map.R_WA = StandingAxes(model);
  const Vector3d left = map.R_WA.col(1);
  for (std::size_t i = 0; i < 2; ++i) {
    map.legs[i] = MakeHumanLimb(model, X_WS, kLeg, i == 0, left);
    map.arms[i] = MakeHumanLimb(model, X_WS, kArm, i == 0, left);
  }
  map.pelvis = Find(model, {"root_joint", "pelvis"}, false);
  map.chest = Find(model, {"BTy_joint", "torso", "thorax"}, false);
  map.R_PA = X_WS[map.pelvis].linear().transpose() * map.R_WA;
  map.R_CA = X_WS[map.chest].linear().transpose() * map.R_WA;
  PoseTrajectory standing;
  standing.rate = 1;
  for (int j = 0; j < model.num_joints(); ++j) standing.joint_names.push_back(model.joint(j).name);
  standing.postures = {posture};
  FindFeet(model, X_WS, MoveFeet(model, standing), &body);
  return body;
}

HumanMotion MoveHuman(const KinematicModel& model, const HumanBody& body,
                      const PoseTrajectory& motion) {
  HumanMotion moved;
  moved.rate = motion.rate;
  moved.first_time = motion.first_time;
  const int frames = motion.num_frames();
  for (std::size_t i = 0; i < 2; ++i) {
    moved.heels[i].resize(3, frames);
    moved.toes[i].resize(3, frames);
  }
  for (int k = 0; k < frames; ++k) {
    const auto X_WS = SegmentPoses(model, ModelPosture(model, motion, k));
    moved.bodies.push_back(PostureOfBody(body.map, X_WS));
    for (std::size_t i = 0; i < 2; ++i) {
      moved.heels[i].col(k) = X_WS[body.heels[i].segment] * body.heels[i].p_S;
      moved.toes[i].col(k) = X_WS[body.toes[i].segment] * body.toes[i].p_S;
      moved.R_feet[i].push_back(X_WS[body.map.legs[i]->end].linear() * body.R_FA[i]);
    }
  }
  return moved;
}

}  // namespace mmm_converter
