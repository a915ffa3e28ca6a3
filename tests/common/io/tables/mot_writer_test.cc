// SPDX-License-Identifier: MIT
#include "common/io/tables/osim_tables.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "common/math/rotation.h"
#include "tests/support/strict_tables.h"

namespace mmm_converter {
namespace {

using testing::ReadStrictMot;
using testing::StrictTable;

constexpr double kRadians = std::numbers::pi / 180;

PoseTrajectory OneJoint(const std::vector<Posture>& postures) {
  PoseTrajectory trajectory;
  trajectory.rate = 100;
  trajectory.first_time = 0.5;
  trajectory.joint_names = {"LKx_joint"};
  trajectory.postures = postures;
  return trajectory;
}

Posture At(const Eigen::Vector3d& rpy) {
  Posture q;
  q.position = {0.001, -0.0125, 1};
  q.orientation = Eigen::Quaterniond(RotationFromRpy(rpy));
  q.joint_angles = Eigen::VectorXd::Constant(1, -0.5);
  return q;
}

TEST(MotWriterTest, WritesEveryByteOfTheFormat) {
  const PoseTrajectory trajectory = OneJoint({At({0.25, 0, 3.125}), At({0.25, 0, 3.25})});
  EXPECT_EQ(Join(FormatMot(trajectory, "root_joint")),
            "Coordinates\nversion=1\nnRows=2\nnColumns=8\ninDegrees=yes\n\n"
            "Seconds, metres, degrees; y is up.\n"
            "The rotation of root_joint is Ry(ry) Rz(rz) Rx(rx), about axes that turn with it.\n"
            "endheader\n"
            "time\troot_joint_tx\troot_joint_ty\troot_joint_tz\troot_joint_rx\troot_joint_ry\t"
            "root_joint_rz\tLKx_joint\n"
            "0.5\t0.001\t1\t0.0125\t14.3239449\t179.049311\t0\t-28.6478898\n"
            // Turned on through a half turn: the angle goes on, too.
            "0.51\t0.001\t1\t0.0125\t14.3239449\t186.2112834\t0\t-28.6478898\n");
}

TEST(MotWriterTest, TheRootsAnglesAreItsRotationWithYUp) {
  // W and the root's axes, turned so that z becomes y: about x by a quarter turn.
  const Eigen::Matrix3d Q =
      Eigen::AngleAxisd(-std::numbers::pi / 2, Eigen::Vector3d::UnitX()).toRotationMatrix();
  std::mt19937 random(7);
  std::uniform_real_distribution<double> angle(-3, 3);
  for (int i = 0; i < 50; ++i) {
    const Posture q = At({angle(random), angle(random), angle(random)});
    const PoseTrajectory trajectory = OneJoint({q});
    const StrictTable mot = ReadStrictMot(Join(FormatMot(trajectory, "hips")));
    const auto about = [&](const char* column, const Eigen::Vector3d& axis) {
      return Eigen::AngleAxisd(kRadians * mot.At(0, column), axis).toRotationMatrix();
    };
    const Eigen::Matrix3d rotation = about("hips_ry", Eigen::Vector3d::UnitY()) *
                                     about("hips_rz", Eigen::Vector3d::UnitZ()) *
                                     about("hips_rx", Eigen::Vector3d::UnitX());
    // Three angles of seven decimals of a degree.
    EXPECT_LE((rotation - Q * q.orientation.toRotationMatrix() * Q.transpose()).norm(), 1e-8);
  }
}

TEST(MotWriterTest, NamesBecomeWordsThatDiffer) {
  PoseTrajectory trajectory = OneJoint({At({0, 0, 0})});
  trajectory.joint_names = {"my root_tx"};
  EXPECT_THAT(ReadStrictMot(Join(FormatMot(trajectory, "my root"))).columns,
              ::testing::ElementsAre("time", "my_root_tx", "my_root_ty", "my_root_tz", "my_root_rx",
                                     "my_root_ry", "my_root_rz", "my_root_tx_2"));
}

}  // namespace
}  // namespace mmm_converter
