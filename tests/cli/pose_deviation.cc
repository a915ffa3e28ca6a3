// SPDX-License-Identifier: MIT
#include "tests/cli/pose_deviation.h"

#include <Eigen/SVD>
#include <cmath>
#include <stdexcept>

namespace mmm_converter::testing {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

Deviation DeviationOf(const std::vector<Isometry3d>& ours, const std::vector<Isometry3d>& stored) {
  Matrix3d sum = Matrix3d::Zero();
  Vector3d place = Vector3d::Zero();
  for (std::size_t k = 0; k < ours.size(); ++k) {
    const Isometry3d between = ours[k].inverse() * stored[k];
    sum += between.linear();
    place += between.translation() / static_cast<double>(ours.size());
  }
  const Eigen::JacobiSVD<Matrix3d> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Matrix3d R = svd.matrixU() * svd.matrixV().transpose();
  Deviation deviation;
  for (std::size_t k = 0; k < ours.size(); ++k) {
    const Eigen::AngleAxisd turn(stored[k].linear().transpose() * ours[k].linear() * R);
    deviation.millimetres += (1e3 * (ours[k] * place - stored[k].translation())).squaredNorm();
    deviation.degrees += std::pow(turn.angle() * 180 / EIGEN_PI, 2);
  }
  const auto count = static_cast<double>(ours.size());
  return {std::sqrt(deviation.millimetres / count), std::sqrt(deviation.degrees / count)};
}

std::vector<Isometry3d> PosesOf(const MmmMotion& motion) {
  std::vector<Isometry3d> poses;
  for (const Posture& posture : motion.trajectory.postures) {
    Isometry3d X = Isometry3d::Identity();
    X.linear() = posture.orientation.toRotationMatrix();
    X.translation() = posture.position;
    poses.push_back(X);
  }
  return poses;
}

const MmmMotion& FindMotion(const MmmMotionFile& file, const std::string& name) {
  const MmmMotion* motion = file.Find(name);
  if (motion == nullptr) throw std::runtime_error("there is no motion " + name);
  return *motion;
}

}  // namespace mmm_converter::testing
