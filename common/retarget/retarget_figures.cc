// SPDX-License-Identifier: MIT
#include "common/retarget/retarget_figures.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/math/square.h"
#include "common/math/statistics.h"
#include "common/model/forward_kinematics.h"
#include "common/retarget/foot_figures.h"
#include "common/retarget/limb_directions.h"
#include "common/retarget/self_contact.h"

namespace mmm_converter {
namespace {

using Eigen::Vector3d;

constexpr double kBeyond = 2e-6;      // [rad] of a position beyond its limit that counts
constexpr double kAtLimit = 1e-3;     // [rad]
constexpr double kAtSpeed = 0.98;     // of a velocity limit
constexpr double kLeastShare = 0.02;  // of the frames at a limit that are worth a word
constexpr double kBetterShare = 0.7;  // another reading of the sides fits better below
constexpr double kBetterAngle = 2;    // [deg] and by so much
constexpr double kLeastPath = 0.2;    // [m] rms of a person who goes somewhere
constexpr double kDegree = std::numbers::pi / 180;

/// The person's map without the limbs that the robot has not.
BodyMap LimbsOfBoth(const BodyMap& robot) {
  BodyMap map;
  map.legs = robot.legs;
  map.arms = robot.arms;
  return map;
}

/// Limbs stand in fours, left and right in twos.
std::size_t OtherSide(std::size_t limb) { return limb ^ 2U; }

class DirectionMeasure {
 public:
  DirectionMeasure(const Retargeted& retargeted, const RobotBody& body, const PosesOverTime& X_WS)
      : retargeted_(retargeted) {
    const BodyMap map = LimbsOfBoth(body.map);
    const bool by_chest = !body.feet;
    names_ = NamesOfLimbs(map);
    errors_.resize(names_.size());
    for (int k = 0; k < retargeted.human.num_frames(); ++k) {
      const LimbDirections person = DirectionsOf(map, retargeted.human.bodies[k], by_chest);
      const LimbDirections robot = DirectionsOf(map, PostureOfBody(body.map, X_WS[k]), by_chest);
      if (!person.is_known || !robot.is_known) continue;
      frames_.push_back(k);
      turned_ += std::abs(std::remainder(robot.heading - person.heading, 2 * std::numbers::pi));
      AddFrame(person, robot);
    }
    is_fixed_ = by_chest;
  }

  void Conclude(RetargetFigures* figures) const {
    std::vector<double> all;
    for (std::size_t n = 0; n < names_.size() && !frames_.empty(); ++n) {
      const std::vector<double>& errors = errors_[n];
      const auto most = std::max_element(errors.begin(), errors.end());
      const int at = frames_[static_cast<std::size_t>(most - errors.begin())];
      figures->limbs.push_back({names_[n], Mean(errors), Percentile(errors, 95), *most,
                                retargeted_.motion.time(at), InAllFrames(errors)});
      all.insert(all.end(), errors.begin(), errors.end());
    }
    if (all.empty()) return;
    figures->direction = Mean(all);
    figures->direction95 = Percentile(all, 95);
    const auto count = static_cast<double>(all.size());
    const double other = std::min(exchanged_, reflected_) / count;
    figures->is_mirrored = other < kBetterShare * figures->direction &&
                           other < figures->direction - kBetterAngle * kDegree;
    figures->is_backwards =
        !is_fixed_ && turned_ / static_cast<double>(frames_.size()) > std::numbers::pi / 2;
  }

 private:
  static double Mean(const std::vector<double>& values) {
    double sum = 0;
    for (const double value : values) sum += value;
    return sum / static_cast<double>(values.size());
  }

  std::vector<double> InAllFrames(const std::vector<double>& errors) const {
    std::vector<double> all(retargeted_.motion.postures.size(), NAN);
    for (std::size_t i = 0; i < frames_.size(); ++i) all[frames_[i]] = errors[i];
    return all;
  }

  void AddFrame(const LimbDirections& person, const LimbDirections& robot) {
    const Eigen::DiagonalMatrix<double, 3> reflect(1, -1, 1);
    for (std::size_t n = 0; n < robot.count; ++n) {
      errors_[n].push_back(AngleBetween(person.limbs[n], robot.limbs[n]));
      const Vector3d& other = person.limbs[OtherSide(n)];
      exchanged_ += AngleBetween(other, robot.limbs[n]);
      reflected_ += AngleBetween(reflect * other, robot.limbs[n]);
    }
  }

  const Retargeted& retargeted_;
  std::vector<std::string> names_;
  std::vector<std::vector<double>> errors_;
  std::vector<int> frames_;  // whose directions are known
  double exchanged_ = 0, reflected_ = 0, turned_ = 0;
  bool is_fixed_ = false;
};

/// Root mean squares of differences over the joints that move.
void MeasureSmoothness(const PoseTrajectory& motion, RetargetFigures* figures) {
  const int frames = motion.num_frames();
  const Eigen::Index joints = motion.postures[0].joint_angles.size();
  const auto q = [&](int k) -> const Eigen::VectorXd& { return motion.postures[k].joint_angles; };
  Eigen::VectorXd lowest = q(0), highest = q(0);
  for (int k = 1; k < frames; ++k) {
    lowest = lowest.cwiseMin(q(k));
    highest = highest.cwiseMax(q(k));
    const double way = (motion.postures[k].position - motion.postures[k - 1].position).norm();
    figures->root_speed = std::max(figures->root_speed, way * motion.rate);
    if (joints == 0) continue;
    figures->largest_jump =
        std::max(figures->largest_jump, (q(k) - q(k - 1)).cwiseAbs().maxCoeff());
  }
  const Eigen::ArrayXd moves = ((highest - lowest).array() > kMoves).cast<double>();
  const double moving = std::max(1.0, moves.sum());
  double second = 0, third = 0;
  for (int k = 2; k < frames; ++k) {
    second += (moves * (q(k) - 2 * q(k - 1) + q(k - 2)).array()).square().sum();
    if (k < 3) continue;
    third += (moves * (q(k) - 3 * q(k - 1) + 3 * q(k - 2) - q(k - 3)).array()).square().sum();
  }
  const double rate = motion.rate;
  figures->acceleration = Square(rate) * std::sqrt(second / moving / std::max(1, frames - 2));
  figures->jerk = rate * Square(rate) * std::sqrt(third / moving / std::max(1, frames - 3));
}

void MeasureHolds(const Retargeted& retargeted, const RobotBody& body, const PosesOverTime& X_WS,
                  RetargetFigures* figures) {
  const Vector3d floor = FloorOf(retargeted) * Vector3d::UnitZ();
  for (const Hold& hold : retargeted.holds) {
    const BodyPoint& palm = body.palms[hold.hand];
    if (palm.segment < 0) continue;
    HoldFigures& one = figures->holds.emplace_back();
    one.object = retargeted.objects[hold.object].name;
    one.hand = Name(kSides[hold.hand]);
    one.begin = retargeted.motion.time(hold.begin);
    one.end = retargeted.motion.time(hold.end - 1);
    for (int k = hold.begin; k < hold.end; ++k) {
      const Vector3d wanted =
          retargeted.scale * (PalmOf(retargeted.human.bodies[k].arms[hold.hand]) - floor);
      const double off = (X_WS[k][palm.segment] * palm.p_S - wanted).norm();
      one.mean += off / (hold.end - hold.begin);
      if (off > one.most) one.most_time = retargeted.motion.time(k);
      one.most = std::max(one.most, off);
    }
  }
}

void MeasureLimits(const PoseTrajectory& motion, const Robot& robot, const RobotBody& body,
                   RetargetFigures* figures) {
  const int frames = motion.num_frames();
  for (int j = 0; j < robot.model.num_joints(); ++j) {
    int at_limit = 0, at_speed = 0;
    for (int k = 0; k < frames; ++k) {
      const double q = motion.postures[k].joint_angles[j];
      const double speed =
          k == 0 ? 0 : std::abs(q - motion.postures[k - 1].joint_angles[j]) * motion.rate;
      const JointState state = StateOf(robot, j, q, speed);
      figures->position_breaks += state.is_beyond ? 1 : 0;
      figures->velocity_breaks += state.is_too_fast ? 1 : 0;
      at_limit += state.is_at_limit ? 1 : 0;
      at_speed += state.is_at_speed ? 1 : 0;
    }
    if (std::count(body.held.begin(), body.held.end(), j) > 0) continue;
    AddJointFigures({robot.model.joint(j).name, static_cast<double>(at_limit) / frames,
                     static_cast<double>(at_speed) / frames},
                    figures);
  }
}

double PathOf(const Retargeted& retargeted, const BodyMap& map, const PosesOverTime& X_WS) {
  const auto frames = static_cast<Eigen::Index>(X_WS.size());
  Eigen::Matrix3Xd person(3, frames), robot(3, frames);
  for (Eigen::Index k = 0; k < frames; ++k) {
    person.col(k) = retargeted.human.bodies[k].mid_hip;
    robot.col(k) = PostureOfBody(map, X_WS[k]).mid_hip;
  }
  person.colwise() -= person.rowwise().mean().eval();
  robot.colwise() -= robot.rowwise().mean().eval();
  if (person.norm() < kLeastPath * std::sqrt(static_cast<double>(frames))) return NAN;
  return robot.norm() / person.norm() / retargeted.scale;
}

}  // namespace

JointState StateOf(const Robot& robot, int j, double q, double speed) {
  const Segment& joint = robot.model.joint(j);
  const double fastest = robot.velocity_limits[j];
  return {q < joint.lower - kBeyond || q > joint.upper + kBeyond,
          q < joint.lower + kAtLimit || q > joint.upper - kAtLimit, speed > fastest,
          speed > kAtSpeed * fastest};
}

void AddJointFigures(JointFigures joint, RetargetFigures* figures) {
  if (joint.share_at_limit <= kLeastShare && joint.share_at_speed == 0) return;
  const auto share = [](const JointFigures& one) {
    return one.share_at_limit + one.share_at_speed;
  };
  const auto place =
      std::upper_bound(figures->joints.begin(), figures->joints.end(), joint,
                       [&](const auto& a, const auto& b) { return share(a) > share(b); });
  figures->joints.insert(place, std::move(joint));
}

RetargetFigures MeasureRetargeting(const Retargeted& retargeted, const Robot& robot,
                                   const RobotBody& body) {
  RetargetFigures figures;
  figures.rate = retargeted.motion.rate;
  figures.num_frames = retargeted.motion.num_frames();
  figures.keeps_limits = retargeted.keeps_limits;
  PosesOverTime X_WS;
  for (int k = 0; k < figures.num_frames; ++k) {
    Posture posture = retargeted.motion.postures[static_cast<std::size_t>(k)];
    posture.position -= WayOfBelt(retargeted, k);
    X_WS.push_back(SegmentPoses(robot.model, posture));
  }
  figures.slide = figures.toe_slide = figures.floating = figures.path = NAN;
  figures.direction = figures.direction95 = NAN;
  if (body.feet) {
    MeasureFeet(retargeted, body, X_WS, &figures);
    MeasureBodyDepth(retargeted.motion, body, X_WS, &figures);
    figures.path = PathOf(retargeted, body.map, X_WS);
  }
  MeasureSelfContact(retargeted.motion, body.capsules, X_WS, &figures);
  MeasureHolds(retargeted, body, X_WS, &figures);
  MeasureLimits(retargeted.motion, robot, body, &figures);
  MeasureSmoothness(retargeted.motion, &figures);
  DirectionMeasure(retargeted, body, X_WS).Conclude(&figures);
  return figures;
}

}  // namespace mmm_converter
