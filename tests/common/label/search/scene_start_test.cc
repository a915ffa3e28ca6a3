// SPDX-License-Identifier: MIT
#include "common/label/search/scene_start.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/math/seeded_random.h"
#include "common/support/error.h"
#include "tests/common/label/made_person.h"

namespace mmm_converter::testing {
namespace {

using Eigen::Matrix3Xd;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

std::vector<Matrix3Xd> FramesOf(const MadePerson& made) {
  std::vector<Matrix3Xd> frames;
  for (int k = 0; k < made.recording.num_frames(); ++k) frames.push_back(made.PointsAt(k));
  return frames;
}

TEST(SceneStartTest, APersonIsFoundWhereMostIsSeen) {
  const MadePerson made(41, 0.1);
  std::vector<Matrix3Xd> frames = FramesOf(made);
  for (std::size_t k = 0; k + 3 < frames.size(); ++k) frames[k] = frames[k].leftCols(9).eval();
  const std::vector<SceneStart> starts = FindScene({&made.body}, frames);
  ASSERT_FALSE(starts.empty());
  EXPECT_GE(starts.front().frame, static_cast<int>(frames.size()) - 3);
  EXPECT_EQ(CountOwn(starts.front().matches[0].point_of_marker), made.body.num_markers());
  for (std::size_t i = 1; i < starts.size(); ++i) {
    EXPECT_GE(starts[i].matches[0].cost, starts[i - 1].matches[0].cost);
  }
}

// The second is 40 cm smaller, and stands first in the points.
TEST(SceneStartTest, TwoPersonsWhoStandApartAreToldApart) {
  const MadePerson tall(42, 0.1);
  const KinematicModel small_model = ScaledReferenceModel(1.35);
  const MarkerSequence small =
      RecordPerson(small_model, RangeOfMotion(small_model, 0.1, 0.6, 43), 43);
  const LabelBody small_body(
      SetupOf(small_model, TrackedJoints(small_model), AssignAll(small_model, small)));
  std::vector<Matrix3Xd> frames;
  for (int k = 0; k < 1; ++k) {
    Matrix3Xd points(3, small.num_labels() + tall.body.num_markers());
    points << small.frame(k).colwise() + Eigen::Vector3d(2, 0, 0), tall.PointsAt(k);
    frames.push_back(points);
  }
  const SceneStart start = FindScene({&tall.body, &small_body}, frames).front();
  EXPECT_NEAR(start.matches[0].posture.position.x(), tall.PostureAt(start.frame).position.x(), 0.1);
  EXPECT_NEAR(start.matches[1].posture.position.x(), 2, 0.5);
}

TEST(SceneStartTest, APersonOfAnotherSizeIsSaid) {
  const MadePerson made(45, 0.1);
  const auto find = [&](double size) {
    const Matrix3Xd points = size * made.PointsAt(0);
    const SceneStart start = FindScene({&made.body}, {points}).front();
    CheckSize(made.body, points, start.matches[0]);
  };
  EXPECT_NO_THROW(find(1));
  EXPECT_THAT([&] { find(1.3); }, ThrowsMessage<Error>(HasSubstr("1.28 times as tall")));
}

TEST(SceneStartTest, NoiseAndTooFewPointsAreErrors) {
  const MadePerson made(44, 0.1);
  SeededRandom random(44);
  Matrix3Xd noise(3, made.body.num_markers());
  for (double& x : noise.reshaped()) x = 20 * random.Uniform();
  EXPECT_THROW(FindScene({&made.body}, {noise}), Error);
  EXPECT_THROW(FindScene({&made.body}, {made.PointsAt(0).leftCols(9)}), Error);
  EXPECT_THROW(FindScene({&made.body}, {}), Error);
  int frames = 0;
  const auto stop = [&] {
    if (++frames == 2) throw Error("enough");
  };
  EXPECT_THROW(
      FindScene({&made.body}, {made.PointsAt(0), made.PointsAt(1), made.PointsAt(2)}, stop), Error);
  EXPECT_EQ(frames, 2);
}

}  // namespace
}  // namespace mmm_converter::testing
