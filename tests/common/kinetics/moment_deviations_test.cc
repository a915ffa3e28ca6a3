// SPDX-License-Identifier: MIT
// Made persons who walk on one foot with the forces that their motion needs: how far moments are
// off, and whether their deviations say so.
#include "common/kinetics/moment_deviations.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/math/seeded_random.h"
#include "tests/common/kinetics/made_walker.h"

namespace mmm_converter {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr int kPersons = 40;  // of each seed

VectorXd Normals(Index size, SeededRandom* random) {
  VectorXd all(size);
  for (double& one : all) one = random->Normal();
  return all;
}

/// Of errors that last: 5 mm, 0.02 rad of the root and 0.03 rad of joints, which hang together.
Eigen::MatrixXd PostureErrors(Index size, SeededRandom* random) {
  Eigen::MatrixXd B = 0.4 * Normals(size * size, random).reshaped(size, size);
  B.diagonal().array() += 1;
  VectorXd deviations = VectorXd::Constant(size, 0.03);
  deviations.head<3>().setConstant(0.005);
  deviations.segment<3>(3).setConstant(0.02);
  return (deviations.array() / B.rowwise().norm().array()).matrix().asDiagonal() * B;
}

struct Score {
  int count = 0, within_one = 0, within_two = 0;
  double squares = 0, peak = 0;

  void Add(const JointForces& found, const JointForces& truth) {
    for (Index k = 20; k < found.forces.cols() - 20; k += 10) {
      for (Index i = 0; i < found.forces.rows(); ++i) {
        const double deviation = found.deviations(i, k);
        if (!(deviation > 0)) continue;  // toes weigh nothing
        const double error = std::abs(found.forces(i, k) - truth.forces(i, k));
        ++count;
        if (error < deviation) ++within_one;
        if (error < 2 * deviation) ++within_two;
        squares += error * error;
        peak = std::max(peak, std::abs(truth.forces(i, k)));
      }
    }
  }
};

class MomentDeviationsTest : public ::testing::TestWithParam<std::uint64_t> {};

TEST_P(MomentDeviationsTest, SayHowFarMomentsAreOff) {
  Score score;
  const testing::MadeWalker walker;
  const JointForces truth =
      ComputeJointForces(walker.model, walker.motion, walker.contacts, walker.forces);
  EXPECT_LT(MeasureResiduals(truth).force.rms, 2);  // what the low-pass takes away
  SeededRandom random(GetParam());
  for (int person = 0; person < kPersons; ++person) {
    const ForceErrors sizes;
    const Index size = 6 + walker.model.num_joints();
    const Eigen::MatrixXd B = PostureErrors(size, &random);
    PoseTrajectory motion = walker.motion;
    const VectorXd lasting = B * Normals(size, &random);
    for (Posture& one : motion.postures) {
      VectorXd white = 0.002 * Normals(size, &random);
      white.head<3>() /= 4;
      one = Retract(one, lasting + white);
    }
    ModelDescription body = DescriptionOf(walker.model);
    for (Segment& one : body.segments) {
      const double factor = 1 + sizes.mass * random.Normal();
      one.mass *= factor;
      one.inertia *= factor;
    }
    RecordedForces forces = walker.forces;
    const Eigen::Vector3d moved =
        sizes.center_of_pressure * Eigen::Vector3d(random.Normal(), random.Normal(), 0);
    for (Index k = 0; k < forces.plates[0].force.cols(); ++k) {
      forces.plates[0].moment.col(k) += moved.cross(Eigen::Vector3d(forces.plates[0].force.col(k)));
    }
    const KinematicModel model(body);
    JointForces found = ComputeJointForces(model, motion, walker.contacts, forces);
    EstimateDeviations(model, motion, walker.contacts, forces, {{0, B * B.transpose()}}, sizes,
                       &found);
    score.Add(found, truth);
  }
  const double one = static_cast<double>(score.within_one) / score.count;
  const double two = static_cast<double>(score.within_two) / score.count;
  EXPECT_GT(one, 0.60);
  EXPECT_LT(one, 0.80);
  EXPECT_GT(two, 0.90);
  EXPECT_LT(two, 0.98);
  const double rms = std::sqrt(score.squares / score.count);
  EXPECT_LT(rms, 0.06 * score.peak) << rms << " of " << score.peak;
}

INSTANTIATE_TEST_SUITE_P(Seeds, MomentDeviationsTest, ::testing::Values(5, 6, 7));

}  // namespace
}  // namespace mmm_converter
