// SPDX-License-Identifier: MIT
#include "common/retarget/smpl_motion.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <utility>

#include "common/math/rotation.h"
#include "common/model/forward_kinematics.h"
#include "common/motion/marker_synthesis.h"

namespace mmm_converter {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::MatrixXd;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using Eigen::VectorXd;

// SmplJoints(), of the left; the right one follows.
namespace smpl {
enum Joint {
  kHip = 1,
  kSpine1 = 3,
  kKnee = 4,
  kSpine2 = 6,
  kAnkle = 7,
  kSpine3 = 9,
  kFoot = 10,
  kNeck = 12,
  kCollar = 13,
  kHead = 15,
  kShoulder = 16,
  kElbow = 18,
  kWrist = 20
};
}  // namespace smpl

/// Axes of a body that stands, forward, left and up, in SMPL's.
Matrix3d BodyAxes() {
  Matrix3d axes;
  axes << Vector3d::UnitZ(), Vector3d::UnitX(), Vector3d::UnitY();
  return axes;
}

/// Those of an arm that hangs (LimbSegment), when it is stretched out to its side.
Matrix3d ArmAxes(int side) {
  const double left = side == 0 ? 1 : -1;
  Matrix3d axes;
  axes << Vector3d::UnitZ(), left * Vector3d::UnitY(), -left * Vector3d::UnitX();
  return axes;
}

Vector3d MidHip(const Matrix3Xd& p) { return (p.col(smpl::kHip) + p.col(smpl::kHip + 1)) / 2; }
Vector3d MidShoulder(const Matrix3Xd& p) {
  return (p.col(smpl::kShoulder) + p.col(smpl::kShoulder + 1)) / 2;
}

/// The lengths by which a shape is told.
VectorXd Lengths(const Matrix3Xd& p) {
  VectorXd lengths(11);
  Index i = 0;
  const auto add = [&](int a, int b) { lengths[i++] = (p.col(a) - p.col(b)).norm(); };
  add(smpl::kHip, smpl::kHip + 1);
  add(smpl::kShoulder, smpl::kShoulder + 1);
  for (const int side : {0, 1}) {
    add(smpl::kHip + side, smpl::kKnee + side);
    add(smpl::kKnee + side, smpl::kAnkle + side);
    add(smpl::kShoulder + side, smpl::kElbow + side);
    add(smpl::kElbow + side, smpl::kWrist + side);
  }
  lengths[i] = (MidHip(p) - MidShoulder(p)).norm();
  return lengths;
}

VectorXd LengthsOf(const BodyPosture& body) {
  Matrix3Xd p = Matrix3Xd::Zero(3, kSmplJoints);
  for (int side = 0; side < 2; ++side) {
    const LimbPosture& leg = body.legs[static_cast<std::size_t>(side)];
    const LimbPosture& arm = body.arms[static_cast<std::size_t>(side)];
    p.col(smpl::kHip + side) = leg.proximal;
    p.col(smpl::kKnee + side) = leg.middle;
    p.col(smpl::kAnkle + side) = leg.distal;
    p.col(smpl::kShoulder + side) = arm.proximal;
    p.col(smpl::kElbow + side) = arm.middle;
    p.col(smpl::kWrist + side) = arm.distal;
  }
  return Lengths(p);
}

/// Gauss and Newton's steps; betas are of people as they are, with a deviation of 1.
std::vector<double> FitBetas(const SmplModel& smpl, const VectorXd& lengths) {
  constexpr int kSteps = 10;
  constexpr double kDeviation = 1e-3;  // of a length [m]
  constexpr double kStep = 1e-3;       // of a beta, for derivatives
  std::vector<double> betas(smpl.directions.size(), 0);
  const auto count = static_cast<Index>(betas.size());
  for (int step = 0; step < kSteps && count > 0; ++step) {
    const VectorXd now = Lengths(smpl.Joints(betas));
    MatrixXd J(lengths.size(), count);
    for (Index b = 0; b < count; ++b) {
      std::vector<double> moved = betas;
      moved[static_cast<std::size_t>(b)] += kStep;
      J.col(b) = (Lengths(smpl.Joints(moved)) - now) / kStep / kDeviation;
    }
    const Eigen::Map<VectorXd> at(betas.data(), count);
    const VectorXd gradient = J.transpose() * ((lengths - now) / kDeviation) - at;
    const MatrixXd A = J.transpose() * J + MatrixXd::Identity(count, count);
    const VectorXd change = A.ldlt().solve(gradient);
    for (Index b = 0; b < count; ++b) betas[static_cast<std::size_t>(b)] += change[b];
  }
  return betas;
}

/// A person's frames as rotations of SMPL's joints.
class SmplPoser {
 public:
  SmplPoser(const KinematicModel& model, const HumanBody& body, Matrix3Xd rest)
      : body_(body), rest_(std::move(rest)), head_(model.FindSegment("HeadSegment_joint")) {
    if (head_ < 0) return;
    const auto X_WS = SegmentPoses(model, StandingPosture(model));
    R_HA_ = X_WS[static_cast<std::size_t>(head_)].linear().transpose() * body.map.R_WA;
  }

  void Pose(const std::vector<Eigen::Isometry3d>& X_WS, Eigen::Ref<VectorXd> turns,
            Eigen::Ref<Vector3d> translation) {
    const BodyPosture posture = PostureOfBody(body_.map, X_WS);
    PoseTrunk(posture, X_WS);
    for (int side = 0; side < 2; ++side) PoseLimbs(posture, X_WS, side);
    const Vector3d hip = MidHip(rest_);
    // Turns are about the pelvis.
    translation = posture.mid_hip - R_[0] * (hip - rest_.col(0)) - rest_.col(0);
    for (std::size_t j = 0; j < R_.size(); ++j) {
      const int parent = SmplJoints()[j].parent;
      const Matrix3d above =
          parent < 0 ? Matrix3d(Matrix3d::Identity()) : R_[static_cast<std::size_t>(parent)];
      turns.segment<3>(3 * static_cast<Index>(j)) = Log(Quaterniond(above.transpose() * R_[j]));
    }
  }

 private:
  Vector3d Bone(int from, int to) const { return rest_.col(to) - rest_.col(from); }

  void PoseTrunk(const BodyPosture& posture, const std::vector<Eigen::Isometry3d>& X_WS) {
    const Matrix3d axes = BodyAxes().transpose();
    const Quaterniond pelvis(posture.R_pelvis * axes), chest(posture.R_chest * axes);
    const Matrix3d head =
        head_ < 0 ? Matrix3d(chest.toRotationMatrix())
                  : Matrix3d(X_WS[static_cast<std::size_t>(head_)].linear() * R_HA_ * axes);
    R_[0] = pelvis.toRotationMatrix();
    R_[smpl::kSpine1] = pelvis.slerp(1.0 / 3, chest).toRotationMatrix();
    R_[smpl::kSpine2] = pelvis.slerp(2.0 / 3, chest).toRotationMatrix();
    R_[smpl::kSpine3] = chest.toRotationMatrix();
    R_[smpl::kNeck] = chest.slerp(0.5, Quaterniond(head)).toRotationMatrix();
    R_[smpl::kHead] = head;
    // The back leans to where the shoulders are; the chest stays as it is.
    const Vector3d up = (posture.arms[0].proximal + posture.arms[1].proximal) / 2 - posture.mid_hip;
    const Vector3d to_spine = R_[0] * (rest_.col(smpl::kSpine1) - MidHip(rest_));
    const Vector3d chest_part = R_[smpl::kSpine3] * (MidShoulder(rest_) - rest_.col(smpl::kSpine3));
    const Vector3d back = R_[smpl::kSpine1] * Bone(smpl::kSpine1, smpl::kSpine2) +
                          R_[smpl::kSpine2] * Bone(smpl::kSpine2, smpl::kSpine3);
    const Matrix3d lean = RotationBetween(back, up - to_spine - chest_part);
    R_[smpl::kSpine1] = lean * R_[smpl::kSpine1];
    R_[smpl::kSpine2] = lean * R_[smpl::kSpine2];
  }

  void PoseLimbs(const BodyPosture& posture, const std::vector<Eigen::Isometry3d>& X_WS, int side) {
    const auto i = static_cast<std::size_t>(side);
    const LimbPosture& leg = posture.legs[i];
    const LimbPosture& arm = posture.arms[i];
    const auto aim = [&](int joint, int next, const Matrix3d& R, const Vector3d& along) {
      R_[static_cast<std::size_t>(joint + side)] =
          RotationBetween(R * Bone(joint + side, next + side), along) * R;
    };
    const Matrix3d of_body = BodyAxes().transpose(), of_arm = ArmAxes(side).transpose();
    aim(smpl::kHip, smpl::kKnee, leg.R_upper * of_body, leg.middle - leg.proximal);
    aim(smpl::kKnee, smpl::kAnkle, leg.R_lower * of_body, leg.distal - leg.middle);
    const auto foot = static_cast<std::size_t>(body_.map.legs[i]->end);
    R_[static_cast<std::size_t>(smpl::kAnkle + side)] =
        X_WS[foot].linear() * body_.R_FA[i] * of_body;
    R_[static_cast<std::size_t>(smpl::kFoot + side)] =
        R_[static_cast<std::size_t>(smpl::kAnkle + side)];
    const Vector3d middle = (posture.arms[0].proximal + posture.arms[1].proximal) / 2;
    const Vector3d collar = rest_.col(smpl::kCollar + side) - MidShoulder(rest_);
    aim(smpl::kCollar, smpl::kShoulder, R_[smpl::kSpine3],
        arm.proximal - middle - R_[smpl::kSpine3] * collar);
    aim(smpl::kShoulder, smpl::kElbow, arm.R_upper * of_arm, arm.middle - arm.proximal);
    aim(smpl::kElbow, smpl::kWrist, arm.R_lower * of_arm, arm.distal - arm.middle);
    R_[static_cast<std::size_t>(smpl::kWrist + side)] = arm.R_end * of_arm;
  }

  const HumanBody& body_;
  const Matrix3Xd rest_;
  const int head_;
  Matrix3d R_HA_ = Matrix3d::Identity();
  std::array<Matrix3d, kSmplJoints> R_;  ///< in W, of SMPL's axes
};

}  // namespace

SmplMotion MakeSmplMotion(const KinematicModel& model, const PoseTrajectory& motion,
                          const SmplModel& smpl) {
  const HumanBody body = FindHumanBody(model);
  SmplMotion made;
  made.betas = FitBetas(
      smpl, LengthsOf(PostureOfBody(body.map, SegmentPoses(model, StandingPosture(model)))));
  SmplPoser poser(model, body, smpl.Joints(made.betas));
  made.poses.resize(3 * kSmplJoints, motion.num_frames());
  made.translation.resize(3, motion.num_frames());
  for (int k = 0; k < motion.num_frames(); ++k) {
    poser.Pose(SegmentPoses(model, ModelPosture(model, motion, k)), made.poses.col(k),
               made.translation.col(k));
  }
  return made;
}

}  // namespace mmm_converter
