// SPDX-License-Identifier: MIT
#include "common/fit/posture_search.h"

#include <gtest/gtest.h>

#include "common/motion/marker_synthesis.h"
#include "common/motion/synthetic_motion.h"
#include "tests/support/acrobatics.h"
#include "tests/support/synthetic_person.h"

namespace mmm_converter::testing {
namespace {

constexpr int kAttempts = 32;  // as converters start

// Of single frames: how many starts are as near to the markers as the fit that starts at the truth.
struct Starts {
  int right = 0, all = 0;
};

Starts CountStarts(const KinematicModel& person, const PoseTrajectory& motion, std::uint64_t seed,
                   int every) {
  const MarkerSequence markers = RecordPerson(person, motion, seed);
  const KinematicModel model = ScaledReferenceModel(1.75);
  const std::vector<int> joints = TrackedJoints(model);
  const TrackingSetup setup = SetupOf(model, joints, AssignAll(model, markers));
  const MarkerKinematics kinematics(model, joints, MarkerIndices(setup.assignments()));
  const Eigen::VectorXd scale = Eigen::VectorXd::Ones(kinematics.num_markers());
  PostureFitOptions options;
  options.robust_distance = 0.1;
  PostureSearch search(kinematics);
  Starts starts;
  for (int k = 0; k < motion.num_frames(); k += every) {
    const Eigen::Matrix3Xd z = markers.frame(k)(Eigen::all, LabelIndices(setup.assignments()));
    const Posture truth = ModelPosture(model, motion, k);
    Posture near = {truth.position, truth.orientation, truth.joint_angles(joints)};
    Posture found;
    const double least = search.fit().Solve(z, scale, options, &near).cost;
    starts.right += search.Assemble(z, scale, options, kAttempts, &found).cost < 1.03 * least;
    ++starts.all;
  }
  return starts;
}

TEST(PostureSearch, FindsThePostureOfASingleFrame) {
  Starts sum;
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    const KinematicModel model = ScaledReferenceModel(1.75);
    const KinematicModel person = FitToSubject(model, DrawPerson(model, seed));
    for (const PoseTrajectory& motion : {RangeOfMotion(person, 6, 0.8, seed), MakeHandstand(person),
                                         testing::MakeCartwheel(person)}) {
      const Starts starts = CountStarts(person, motion, seed, 34);
      sum.right += starts.right;
      sum.all += starts.all;
    }
  }
  // Of seeds 5 to 8, which nothing was chosen on, all 200; with 16 attempts 199.
  EXPECT_GE(sum.right, 0.98 * sum.all);
}

}  // namespace
}  // namespace mmm_converter::testing
