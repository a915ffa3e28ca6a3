// SPDX-License-Identifier: MIT
#include "common/retarget/robot_follower.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "common/math/rotation.h"

namespace mmm_converter {
namespace {

using Eigen::Vector3d;

constexpr FootDeviations kFollowed = {0.0001, 0.001, 0.006, 0.1};
constexpr int kStepsAFrame = 3;
constexpr double kStepDamping = 5;  // [1/rad^2]
// What draws a step of 10 ms to none, and its change to none: of the root's place [1/m^2], its turn
// and joints [1/rad^2]. Less than aims, so that the robot is hardly late.
constexpr double kFrameTime = 0.01;
constexpr double kSlow[] = {50, 10, 300}, kSteady[] = {400, 50, 150};
// [1/m^2, 1/rad^2] What draws a robot that lags to where its joints got by themselves: feet that
// stand count more.
constexpr double kAsReached = 1e5;
constexpr int kStepsFirm = 4;
constexpr double kFloorSpring = 1e9;   // [1/m^2]
constexpr double kFarthestStep = 0.5;  // [rad]
// [rad/s, m/s] Faster than people's hips and knees: what a person's posture that is wrong for a
// frame may do. Robots' own speeds are the governor's: a foot that is late does not turn the trunk.
constexpr double kFastest = 25;
constexpr double kSwiftness = 25;  // [1/s] of what follows a foot's pitch and height
// [rad] that a person's foot turns on the ground before the robot's turns, too: more than in walks,
// and less than hips allow. Who turns on the spot turns a foot by a half circle.
constexpr double kFirmTurn = 0.6;
constexpr double kDraw = 0.35;       // [s] in which a swing leaves its place
constexpr double kClears = 0.06;     // [s] in which it gets the person's clearance
constexpr double kRaised = 2;        // [s] after which the floor is where all of the feet are
constexpr double kTooLong = 0.5;     // [s] between frames of a track
constexpr double kLeftBelow = 5e-4;  // [m] of the floor

/// Distance between places of a foot and its edge where it bears.
const Vector3d& PivotOf(const RobotFoot& foot, double pitch) {
  return pitch > 0 ? foot.toe : foot.heel;
}

}  // namespace

void RobotFollower::Follower::Go(double to, double dt) {
  const double off = value - to, fading = std::exp(-kSwiftness * dt);
  const double more = (speed + kSwiftness * off) * dt;
  speed = (speed - kSwiftness * more) * fading;
  value = to + (off + more) * fading;
}

RobotFollower::RobotFollower(std::shared_ptr<const KinematicModel> person, const Robot& robot,
                             const RobotBody& body, double rate, const RobotFollower* before)
    : person_model_(std::move(person)),
      robot_(robot),
      body_(body),
      rate_(rate > 0 ? rate : 100),
      human_(FindHumanBody(*person_model_)),
      scale_(body.size / (body.feet ? human_.leg_length() : human_.arm_length())),
      person_(*person_model_),
      points_{{{PointWatch(human_.heel_heights[0]), PointWatch(human_.toe_heights[0])},
               {PointWatch(human_.heel_heights[1]), PointWatch(human_.toe_heights[1])}}},
      person_aims_(AimsAtPerson(robot, body, scale_)),
      problem_(EmptyProblem(robot, body, rate_, 1)),
      standing_(problem_),
      equations_(problem_),
      standing_equations_(standing_),
      robot_state_(robot.model),
      posture_(ZeroPosture(robot.model)),
      H_(6 + robot.model.num_joints(), 6 + robot.model.num_joints()),
      b_(H_.rows()),
      step_(H_.rows()),
      factor_(H_.rows()) {
  for (const PersonAim& one : person_aims_) problem_.aims.push_back(MakeAim(one, 1));
  for (std::size_t i = 0; i < 2 && body.feet; ++i) {
    for (Aim& aim : MakeFootAims((*body.feet)[i], 1)) {
      standing_.aims.push_back(aim);
      problem_.aims.push_back(std::move(aim));
    }
  }
  standing_.capsules = nullptr;
  standing_.rest_deviation = INFINITY;
  robot_state_.Compute(posture_);
  if (before != nullptr && before->has_begun_) {
    posture_ = before->posture_;
    has_begun_ = true;
    MoveFloor(before->Floor());
  }
  for (Eigen::VectorXd* one : {&lower_, &upper_, &place_, &reached_, &speed_, &other_speed_}) {
    one->setZero(H_.rows());
  }
  before_ = other_posture_ = other_before_ = posture_;
  // Rows of feet get their size here, not where joints are late for the first time.
  for (Aim& aim : standing_.aims) aim.weight.setOnes();
  H_.setZero();
  b_.setZero();
  standing_equations_.AddAims(0, posture_, &H_, &b_);
}

void RobotFollower::WatchPerson(double time) {
  const auto& X_WS = person_.poses();
  for (std::size_t i = 0; i < 2; ++i) {
    R_feet_[i] = X_WS[human_.map.legs[i]->end].linear() * human_.R_FA[i];
    points_[i][0].Take(X_WS[human_.heels[i].segment] * human_.heels[i].p_S, time);
    points_[i][1].Take(X_WS[human_.toes[i].segment] * human_.toes[i].p_S, time);
  }
}

void RobotFollower::MoveFloor(double by) {
  for (auto& foot : points_) {
    for (PointWatch& point : foot) point.SetLevel(point.level() + by);
  }
}

void RobotFollower::MoveLevels(double dt) {
  bool are_raised = true;
  for (const auto& foot : points_) are_raised &= foot[0].is_raised() && foot[1].is_raised();
  raised_for_ = are_raised ? raised_for_ + dt : 0;
  if (raised_for_ < kRaised) return;
  for (auto& foot : points_) {
    for (PointWatch& point : foot) point.SetLevel(point.height_of_level());
  }
}

double RobotFollower::Floor() const {
  return 0.5 * (points_[0][0].level() - human_.heel_heights[0] + points_[1][0].level() -
                human_.heel_heights[1]);
}

std::array<double, 3> RobotFollower::AnglesOfFoot(std::size_t i) const {
  const RobotFoot& foot = (*body_.feet)[i];
  const Eigen::Isometry3d& X = robot_state_.X_WS(foot.segment);
  return {PitchOf(X.linear() * foot.R_FA.col(0)), RollOf(X.linear() * foot.R_FA.col(1)),
          LowestOf(foot, X)};
}

void RobotFollower::Touch(std::size_t i) {
  const RobotFoot& sole = (*body_.feet)[i];
  Foot& foot = feet_[i];
  // Where the robot has it, not where it was to be.
  const Eigen::Isometry3d X =
      has_begun_ && is_following_ ? robot_state_.X_WS(sole.segment) : foot.aim;
  const Vector3d left = X.linear() * sole.R_FA.col(1);
  foot.yaw = std::atan2(-left.x(), left.y());
  foot.pitch = {PitchOf(X.linear() * sole.R_FA.col(0)), 0};
  foot.roll = {sole.rolls ? RollOf(left) : 0, 0};
  foot.height = {std::max(0.0, LowestOf(sole, X)), 0};
  if (is_following_) {
    const std::array<double, 3> now = AnglesOfFoot(i);
    foot.pitch.speed = (now[0] - foot.last[0]) / last_dt_;
    if (sole.rolls) foot.roll.speed = (now[1] - foot.last[1]) / last_dt_;
    foot.height.speed = (now[2] - foot.last[2]) / last_dt_;
  }
  const Vector3d& pivot = PivotOf(sole, foot.pitch.value);
  const Eigen::AngleAxisd R_WY(foot.yaw, Vector3d::UnitZ());
  const Vector3d flat = X * pivot - R_WY * (sole.R_FA.transpose() * (pivot - sole.sole));
  foot.place = flat.head<2>();
  foot.turned = YawOfPerson(i);
  foot.stands = true;
}

double RobotFollower::YawOfPerson(std::size_t i) const {
  const Vector3d left = R_feet_[i].col(1);
  return std::atan2(-left.x(), left.y());
}

void RobotFollower::TurnWithPerson(std::size_t i) {
  const RobotFoot& sole = (*body_.feet)[i];
  Foot& foot = feet_[i];
  const double off = std::remainder(YawOfPerson(i) - foot.turned, 2 * std::numbers::pi);
  const double turn = off - std::clamp(off, -kFirmTurn, kFirmTurn);
  if (turn == 0) return;
  const bool heel = points_[i][0].is_on(), toe = points_[i][1].is_on();
  const Vector3d& pivot = heel == toe ? sole.sole : heel ? sole.heel : sole.toe;
  const Vector3d from_sole = sole.R_FA.transpose() * (pivot - sole.sole);
  const auto about = [&](double yaw) -> Eigen::Vector2d {
    return (Eigen::AngleAxisd(yaw, Vector3d::UnitZ()) * from_sole).head<2>();
  };
  foot.place += about(foot.yaw) - about(foot.yaw + turn);
  foot.yaw += turn;
  foot.turned += turn;
}

void RobotFollower::Stand(std::size_t i, double pitch, double dt) {
  const RobotFoot& sole = (*body_.feet)[i];
  Foot& foot = feet_[i];
  TurnWithPerson(i);
  foot.pitch.Go(pitch, dt);
  foot.height.Go(0, dt);
  double roll = 0;
  if (sole.rolls) {
    foot.roll.Go(0, dt);
    roll = foot.roll.value;
  } else if (is_following_) {  // as its leg leans
    roll = RollOf(robot_state_.X_WS(sole.segment).linear() * sole.R_FA.col(1));
  }
  foot.aim = StandingFoot(sole, foot.place, foot.yaw, foot.pitch.value, roll);
  foot.aim.translation().z() += std::max(0.0, foot.height.value);
}

void RobotFollower::Leave(std::size_t i, const Eigen::Isometry3d& scaled, double dt) {
  Foot& foot = feet_[i];
  foot.stands = false;
  foot.draw = Difference(foot.scaled, foot.aim);  // of the frame before
  Eigen::Isometry3d going_on = foot.aim;          // as it turned about its edge
  Move(Difference(foot.aim_before, foot.aim) * (dt / last_dt_), &going_on);
  foot.draw_slope = (Difference(scaled, going_on) - foot.draw) * (kDraw / dt);
  foot.drawn_for = 0;
}

void RobotFollower::AimFeet(double dt) {
  for (std::size_t i = 0; i < 2; ++i) {
    Foot& foot = feet_[i];
    const Eigen::Isometry3d last = foot.aim;
    // Nobody knows yet how fast feet are in a first frame: a swing is not to begin as a stance.
    const bool heel = is_following_ && points_[i][0].is_on();
    const bool toe = is_following_ && points_[i][1].is_on(), stands = heel || toe;
    ScaledFoot of = {&person_posture_, R_feet_[i], human_.ankle_height, Floor(), scale_, {}};
    const double lifted = foot.stands ? 0 : std::min(1.0, foot.drawn_for / kClears);
    of.clearance = lifted * std::max(0.0, std::min(points_[i][0].height(), points_[i][1].height()));
    const double pitch = GatedPitch(heel, toe, PitchOf(of.R_foot.col(0)));
    const Eigen::Isometry3d swinging = PlaceFoot(of, body_, i);
    if (stands) of.pitch = pitch;
    const Eigen::Isometry3d scaled = stands ? PlaceFoot(of, body_, i) : swinging;
    if (!is_following_) foot.aim = scaled;
    if (stands) {
      if (!foot.stands) Touch(i);
      Stand(i, pitch, dt);
    } else {
      if (foot.stands) Leave(i, scaled, dt);
      foot.drawn_for += dt;
      foot.aim = scaled;
      const double t = foot.drawn_for / kDraw;
      FootDifference draw = FootDifference::Zero();
      for (int j = 0; j < 6 && t < 1; ++j) draw[j] = Fading(foot.draw[j], foot.draw_slope[j], t);
      Move(draw, &foot.aim);
      foot.aim.translation().z() +=
          std::max(0.0, scale_ * of.clearance - LowestOf((*body_.feet)[i], foot.aim));
    }
    foot.scaled = swinging;
    foot.aim_before = is_following_ ? last : foot.aim;
  }
}

void RobotFollower::SetAims(double dt) {
  const double floor = Floor();
  for (std::size_t n = 0; n < person_aims_.size(); ++n) {
    problem_.aims[n].target.col(0) = person_aims_[n].target(person_posture_, floor);
  }
  if (!body_.feet) return;
  AimFeet(dt);
  const FootDeviations followed = Weighed(kFollowed, body_.weights.feet);
  for (std::size_t i = 0; i < 2; ++i) {
    SetFootAims((*body_.feet)[i], feet_[i].aim, feet_[i].stands, followed, 0,
                &problem_.aims[person_aims_.size() + 3 * i]);
  }
}

void RobotFollower::Bound(double way) {
  lower_.head<6>().setConstant(-INFINITY);
  upper_.head<6>().setConstant(INFINITY);
  for (int j = 0; j < robot_.model.num_joints(); ++j) {
    const Segment& joint = robot_.model.joint(j);
    const double q = posture_.joint_angles[j];
    lower_[6 + j] = std::max(joint.lower, q - way);
    upper_[6 + j] = std::min(joint.upper, q + way);
  }
}

void RobotFollower::FindPlace() {
  place_.head<3>() = posture_.position;
  place_.segment<3>(3) = Log(before_.orientation.conjugate() * posture_.orientation);
  place_.tail(posture_.joint_angles.size()) = posture_.joint_angles;
}

bool RobotFollower::HoldAtBounds() {
  bool holds = false;
  FindPlace();
  for (Eigen::Index i = 0; i < lower_.size(); ++i) {
    const double q = place_[i], change = step_[i];
    if (!((q <= lower_[i] && change < 0) || (q >= upper_[i] && change > 0))) continue;
    H_.row(i).setZero();
    H_.col(i).setZero();
    H_(i, i) = 1;
    b_[i] = 0;
    holds = true;
  }
  return holds;
}

void RobotFollower::Advance(double part) {
  posture_.position += part * step_.head<3>();
  const Vector3d turn = part * step_.segment<3>(3);
  posture_.orientation = (posture_.orientation * Exp(turn)).normalized();
  posture_.joint_angles += part * step_.tail(posture_.joint_angles.size());
  FindPlace();
  place_ = place_.cwiseMax(lower_).cwiseMin(upper_);
  posture_.position = place_.head<3>();
  if (std::isfinite(lower_[3]))
    posture_.orientation = (before_.orientation * Exp(Vector3d(place_.segment<3>(3)))).normalized();
  posture_.joint_angles = place_.tail(posture_.joint_angles.size());
}

void RobotFollower::AddPrior(double dt) {
  const double frames = kFrameTime / dt;
  const Eigen::Index joints = posture_.joint_angles.size();
  FootDifference off;  // from the frame before
  off.head<3>() = posture_.position - before_.position;
  off.tail<3>() = Log(before_.orientation.conjugate() * posture_.orientation);
  for (Eigen::Index i = 0; i < 6 + joints; ++i) {
    const Eigen::Index kind = std::min<Eigen::Index>(i / 3, 2);
    const double slow = kSlow[kind] * frames, steady = kSteady[kind] * frames * frames;
    const double moved =
        i < 6 ? off[i] : posture_.joint_angles[i - 6] - before_.joint_angles[i - 6];
    H_(i, i) += slow + steady;
    b_[i] += steady * speed_[i] * dt - (slow + steady) * moved;
  }
}

void RobotFollower::Step() {
  for (int pass = 0; pass < 3; ++pass) {
    factor_.compute(H_);
    step_ = b_;
    factor_.solveInPlace(step_);
    if (!HoldAtBounds()) break;
  }
}

void RobotFollower::Solve(int iterations, double dt) {
  for (int i = 0; i < iterations; ++i) {
    H_.setZero();
    b_.setZero();
    equations_.AddAims(0, posture_, &H_, &b_);
    equations_.AddFloor(kFloorSpring, &contacts_, &H_, &b_);
    if (is_following_) AddPrior(dt);
    H_.diagonal().array() += kStepDamping;
    Step();
    equations_.FindForces(step_, &contacts_);
    const double longest = step_.tail(step_.size() - 3).cwiseAbs().maxCoeff();
    Advance(std::min(1.0, kFarthestStep / longest));
  }
  if (body_.feet && !robot_.model.is_root_fixed())
    posture_.position.z() += std::max(0.0, equations_.DepthOf(posture_) - kLeftBelow);
}

void RobotFollower::FindSpeed(double dt) {
  speed_.head<3>() = (posture_.position - before_.position) / dt;
  speed_.segment<3>(3) = Log(before_.orientation.conjugate() * posture_.orientation) / dt;
  speed_.tail(posture_.joint_angles.size()) = (posture_.joint_angles - before_.joint_angles) / dt;
}

void RobotFollower::Exchange() {
  std::swap(posture_, other_posture_);
  std::swap(before_, other_before_);
  std::swap(speed_, other_speed_);
}

void RobotFollower::HoldFeet(const MotionGovernor& robot) {
  for (std::size_t n = 0; n < standing_.aims.size(); ++n) {
    const Aim& aim = problem_.aims[person_aims_.size() + n];
    standing_.aims[n].target = aim.target;
    standing_.aims[n].weight = aim.weight;
    if (!feet_[n / 3].stands) standing_.aims[n].weight.setZero();
  }
  const Eigen::Index joints = posture_.joint_angles.size();
  FindPlace();
  reached_ = place_;
  lower_.setZero();
  lower_.head<3>() = before_.position;
  lower_.tail(joints) = before_.joint_angles;
  upper_ = (lower_ + robot.most_way()).cwiseMax(reached_);
  lower_ = (lower_ + robot.least_way()).cwiseMin(reached_);
  for (int i = 0; i < kStepsFirm; ++i) {
    H_.setZero();
    b_.setZero();
    standing_equations_.AddAims(0, posture_, &H_, &b_);
    FindPlace();
    H_.diagonal().array() += kAsReached;
    b_ += kAsReached * (reached_ - place_);
    Step();
    Advance(1);
  }
}

const Posture& RobotFollower::StandFirm(const MotionGovernor& robot, double dt) {
  Exchange();
  posture_ = robot.posture();
  before_ = robot.before();
  const bool stands = body_.feet && (feet_[0].stands || feet_[1].stands);
  if (stands) HoldFeet(robot);
  FindSpeed(dt);
  robot_state_.Compute(posture_);
  is_behind_ = !stands;
  if (is_behind_) {
    Exchange();
    return other_posture_;
  }
  for (std::size_t i = 0; i < 2; ++i) {
    if (!feet_[i].stands) continue;
    const RobotFoot& foot = (*body_.feet)[i];
    const Vector3d& pivot = PivotOf(foot, feet_[i].pitch.value);
    feet_[i].place += (robot_state_.X_WS(foot.segment) * pivot - feet_[i].aim * pivot).head<2>();
  }
  return posture_;
}

const Posture& RobotFollower::Follow(const Posture& person, double time) {
  const double dt = time - time_;
  const BodyPosture last = person_posture_;
  person_.Compute(person);
  person_posture_ = PostureOfBody(human_.map, person_.poses());
  has_joined_ = false;
  is_anew_ = !is_following_ || !(dt > 0 && dt < kTooLong) || HasJumped(last, dt) || IsStuck(dt);
  if (is_anew_) {
    Begin(time);
    robot_state_.Compute(posture_);
  } else {
    WatchPerson(time);
    MoveLevels(dt);
    SetAims(dt);
    has_joined_ = is_behind_ && (feet_[0].stands || feet_[1].stands);
    if (has_joined_) Exchange();
    is_behind_ = false;
    Bound(kFastest * dt);
    before_ = posture_;
    Solve(kStepsAFrame, dt);
    FindSpeed(dt);
  }
  for (std::size_t i = 0; i < 2 && body_.feet; ++i) feet_[i].last = AnglesOfFoot(i);
  robot_state_.Compute(posture_);
  last_dt_ = is_anew_ ? 1 / rate_ : dt;
  has_begun_ = is_following_ = true;
  time_ = time;
  return posture_;
}

}  // namespace mmm_converter
