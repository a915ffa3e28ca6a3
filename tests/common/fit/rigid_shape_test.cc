// SPDX-License-Identifier: MIT
#include "common/fit/rigid_shape.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "common/math/rotation.h"
#include "common/support/error.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

// Four markers without any symmetry [m].
const Matrix3Xd kCup = (Matrix3Xd(3, 4) << 0.00, 0.06, 0.01, -0.05,  //
                        0.02, -0.01, 0.09, 0.00,                     //
                        0.00, 0.03, 0.05, 0.12)
                           .finished();

std::vector<std::string> Labels(Eigen::Index count) {
  std::vector<std::string> labels;
  for (Eigen::Index i = 0; i < count; ++i) labels.push_back("cup_" + std::to_string(i));
  return labels;
}

// The body turned and carried about; at frame 0 it stands parallel to the world.
Eigen::Isometry3d PoseAt(int k) {
  const double t = 0.05 * k;
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.linear() = Exp(Vector3d(2 * std::sin(t), std::sin(1.3 * t), 1.7 * t)).toRotationMatrix();
  X.translation() = Vector3d(0.4 + 0.2 * std::sin(t), -0.3 * t, 1 + 0.1 * std::sin(2 * t));
  return X;
}

MarkerSequence Moved(const Matrix3Xd& body, int frames, double noise = 0) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0, 1);
  MarkerSequence recording(Labels(body.cols()), frames, 100, 0);
  for (int k = 0; k < frames; ++k) {
    recording.frame(k) = PoseAt(k) * body;
    if (noise == 0) continue;
    for (double& x : recording.frame(k).reshaped()) x += noise * normal(random);
  }
  return recording;
}

void Hide(int label, int k, MarkerSequence* recording) {
  recording->frame(k).col(label).setConstant(kNaN);
}

Matrix3Xd Centred(const Matrix3Xd& body) { return body.colwise() - body.rowwise().mean(); }

double LargestDistance(const Matrix3Xd& a, const Matrix3Xd& b) {
  return (a - b).colwise().norm().maxCoeff();
}

std::string MessageFor(const MarkerSequence& recording) {
  try {
    EstimateRigidShape(recording);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(RigidShape, IsTheBodyWithItsOriginInTheMean) {
  const RigidShape shape = EstimateRigidShape(Moved(kCup, 200));
  EXPECT_THAT(shape.labels, ElementsAre(0, 1, 2, 3));
  EXPECT_EQ(shape.frames, 200);
  EXPECT_LT(shape.distance, 1e-9);  // exact data: rounding, and kConverged
  EXPECT_LT(LargestDistance(shape.p_OM, Centred(kCup)), 1e-9);
}

TEST(RigidShape, ThreeMarkersAndSymmetricBodiesAreNoLessDetermined) {
  const Matrix3Xd triangle = kCup.leftCols(3);
  EXPECT_LT(LargestDistance(EstimateRigidShape(Moved(triangle, 50)).p_OM, Centred(triangle)), 1e-9);
  const Matrix3Xd square =
      (Matrix3Xd(3, 4) << 1, -1, -1, 1, 1, 1, -1, -1, 0, 0, 0, 0).finished() * 0.1;
  EXPECT_LT(LargestDistance(EstimateRigidShape(Moved(square, 50)).p_OM, square), 1e-9);
}

// No frame shows all five; three common markers link those that show the first and the last.
TEST(RigidShape, IsPutTogetherFromFramesThatShowSomeEach) {
  Matrix3Xd body(3, 5);
  body << kCup, Vector3d(0.1, 0.1, 0.1);
  MarkerSequence recording = Moved(body, 200);
  for (int k = 0; k < 200; ++k) Hide(k % 2 == 0 ? 4 : 0, k, &recording);
  const RigidShape shape = EstimateRigidShape(recording);
  EXPECT_THAT(shape.labels, ElementsAre(0, 1, 2, 3, 4));
  EXPECT_LT(LargestDistance(shape.p_OM, Centred(body)), 1e-8);
}

TEST(RigidShape, AMarkerThatNothingLinksIsLeftOut) {
  Matrix3Xd body(3, 5);
  body << kCup, Vector3d(0.1, 0.1, 0.1);
  MarkerSequence recording = Moved(body, 60);
  for (int k = 0; k < 60; ++k) {
    for (const int label : {0, 1}) {
      if (k < 10) Hide(label, k, &recording);
    }
    if (k < 10) Hide(2, k, &recording);
    if (k >= 10) Hide(4, k, &recording);
  }
  EXPECT_THAT(EstimateRigidShape(recording).labels, ElementsAre(0, 1, 2, 3));
}

TEST(RigidShape, AveragesNoise) {
  constexpr double kNoise = 0.001;
  const int frames = 400;
  const RigidShape shape = EstimateRigidShape(Moved(kCup, frames, kNoise));
  // A mean of 400 has a deviation of noise / 20 in each coordinate; five of them. The orientation
  // of the shape is that of the first frame, which is as noisy as one frame; so compare distances.
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < i; ++j) {
      EXPECT_NEAR((shape.p_OM.col(i) - shape.p_OM.col(j)).norm(),
                  (kCup.col(i) - kCup.col(j)).norm(), 5 * kNoise / 20);
    }
  }
  // Of 12 coordinates of a frame, 6 go into its pose. 2400 that are left tell it to 1.4 %; seven of
  // these.
  EXPECT_NEAR(shape.distance, kNoise * std::sqrt(3 * 0.5), 0.1 * kNoise);
}

TEST(RigidShape, FramesWithSwappedOrJumpingMarkersDoNotCount) {
  MarkerSequence recording = Moved(kCup, 200);
  for (int k = 0; k < 60; ++k) {
    recording.frame(k).col(0).swap(recording.frame(k).col(2));
  }
  for (int k = 150; k < 170; ++k) recording.frame(k).col(1) += Vector3d(0, 0, 0.3);
  const RigidShape shape = EstimateRigidShape(recording);
  EXPECT_EQ(shape.frames, 120);
  EXPECT_LT(shape.distance, 1e-9);
  // The axes are the world's in frame 60.
  EXPECT_LT(LargestDistance(shape.p_OM, PoseAt(60).linear() * Centred(kCup)), 1e-9);
}

// Frames that a frozen recording repeats are no better known than others.
TEST(RigidShape, RepeatedFramesCountOnce) {
  constexpr double kNoise = 0.001;
  const MarkerSequence moved = Moved(kCup, 100, kNoise);
  MarkerSequence recording(Labels(4), 300, 100, 0);
  for (int k = 0; k < 300; ++k) recording.frame(k) = moved.frame(k < 200 ? 0 : k - 200);
  const RigidShape shape = EstimateRigidShape(recording);
  EXPECT_GT(shape.frames, 90);  // a few have noise that is three times the usual
  EXPECT_LE(shape.frames, 100);
}

TEST(RigidShape, AMarkerThatIsRarelySeenIsPlaced) {
  Matrix3Xd body(3, 5);
  body << kCup, Vector3d(0.1, 0.1, 0.1);
  MarkerSequence recording = Moved(body, 6000);
  for (int k = 0; k < 6000; ++k) {
    if (k % 1200 != 7) Hide(4, k, &recording);
  }
  const RigidShape shape = EstimateRigidShape(recording);
  EXPECT_THAT(shape.labels, ElementsAre(0, 1, 2, 3, 4));
  // As far as it has converged; frame 7 is the first that shows all.
  EXPECT_LT(LargestDistance(shape.p_OM, PoseAt(7).linear() * Centred(body)), 1e-8);
}

// Each frame shows four markers of a long chain, so that each step places a few more.
TEST(RigidShape, ALongChainOfMarkersIsPutTogether) {
  const int markers = 250;
  Matrix3Xd body(3, markers);
  for (int i = 0; i < markers; ++i) {
    body.col(i) = Vector3d(0.01 * i, 0.1 * std::sin(i), 0.1 * std::cos(2 * i));
  }
  MarkerSequence recording = Moved(body, markers - 3);
  for (int k = 0; k < markers - 3; ++k) {
    for (int i = 0; i < markers; ++i) {
      if (i < k || i > k + 3) Hide(i, k, &recording);
    }
  }
  EXPECT_EQ(EstimateRigidShape(recording).labels.size(), 250U);
}

TEST(RigidShape, TheSameRecordingGivesTheSameShape) {
  const MarkerSequence recording = Moved(kCup, 3000, 0.001);
  const RigidShape shape = EstimateRigidShape(recording);
  EXPECT_EQ(shape.p_OM, EstimateRigidShape(recording).p_OM);
  EXPECT_LE(shape.frames, 1000);
}

TEST(RigidShape, SaysWhyThereIsNone) {
  EXPECT_THAT(MessageFor(Moved(kCup.leftCols(2), 20)),
              HasSubstr("needs three markers that are seen together; the recording has 2 (cup_0, "
                        "cup_1), at most 2 in a frame"));
  MarkerSequence pairs = Moved(kCup, 20);
  for (int k = 0; k < 20; ++k) {
    Hide(k % 4, k, &pairs);
    Hide((k + 1) % 4, k, &pairs);
  }
  EXPECT_THAT(MessageFor(pairs), HasSubstr("the recording has 4"));
  const Matrix3Xd line = (Matrix3Xd(3, 4) << 0, 0.1, 0.25, 0.3, 0, 0, 0, 0, 0, 0, 0, 0).finished();
  for (const double noise : {0.0, 0.001}) {
    EXPECT_THAT(MessageFor(Moved(line, 100, noise)), HasSubstr("stand on a line")) << noise;
  }
  EXPECT_THAT(MessageFor(MarkerSequence(Labels(4), 10, 100, 0)), HasSubstr("at most 0"));
  EXPECT_THAT(MessageFor(Moved(200 * kCup, 20)), HasSubstr("from their mean, more than 10 m"));
}

TEST(RigidShape, MarkersThatMoveAgainstEachOtherAreNone) {
  MarkerSequence recording = Moved(kCup, 200);
  for (int k = 0; k < 200; ++k) recording.frame(k).col(3) += Vector3d(0, 0, 0.002 * k);
  EXPECT_THAT(MessageFor(recording), HasSubstr("no rigid object"));
}

TEST(FitRigidPose, FindsThePoseAlsoOfPlanarPointsAndHalfTurns) {
  const Matrix3Xd plane = (Matrix3Xd(3, 4) << 0, 1, 1, 0, 0, 0, 1, 2, 0, 0, 0, 0).finished();
  for (const Matrix3Xd& body : {Matrix3Xd(kCup), plane, Matrix3Xd(plane.leftCols(3))}) {
    for (int k = 0; k < 50; ++k) {
      const Eigen::Isometry3d X = PoseAt(7 * k);
      const Eigen::Isometry3d found =
          FitRigidPose(body, X * body, Eigen::VectorXd::Ones(body.cols()));
      EXPECT_TRUE(found.isApprox(X, 1e-9)) << k;  // rounding of a 3 x 3 SVD
    }
  }
}

TEST(DistanceFromLine, IsThatOfTheNearestLine) {
  const Matrix3Xd cross = (Matrix3Xd(3, 4) << 2, -2, 0, 0, 0, 0, 1, -1, 0, 0, 0, 0).finished();
  EXPECT_NEAR(DistanceFromLine(cross), std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(DistanceFromLine(cross.leftCols(2)), 0, 1e-12);
}

}  // namespace
}  // namespace mmm_converter
