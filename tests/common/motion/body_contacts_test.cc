// SPDX-License-Identifier: MIT
#include "common/motion/body_contacts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "common/io/mmm/mmm_model.h"
#include "tests/common/dynamics/test_bodies.h"
#include "tests/support/shared_data.h"

namespace mmm_converter {
namespace {

using Eigen::Vector2d;
using ::testing::ElementsAre;

std::vector<std::string> Names(const std::vector<ContactBody>& bodies) {
  std::vector<std::string> names;
  names.reserve(bodies.size());
  for (const ContactBody& body : bodies) names.push_back(body.name);
  return names;
}

TEST(GroundContact, ThePersonHasFeetAndHands) {
  const KinematicModel model = ReadMmmModel(testing::SourcePath("xml_config/models/mmm.xml"));
  const std::vector<ContactBody> bodies = ContactBodies(model);
  EXPECT_THAT(Names(bodies),
              ElementsAre("left foot", "right foot", "left hand", "right hand", "body"));
  std::vector<std::string> markers;
  for (const int i : bodies[0].markers) markers.push_back(model.markers()[i].name);
  EXPECT_THAT(markers, ElementsAre("MARKER_LANK", "MARKER_LHEE", "MARKER_LMT1", "MARKER_LMT5",
                                   "MARKER_LTOE"));
  std::size_t segments = 0;
  std::size_t all_markers = 0;
  for (const ContactBody& body : bodies) {
    segments += body.segments.size();
    all_markers += body.markers.size();
  }
  EXPECT_EQ(segments, model.segments().size());
  EXPECT_EQ(all_markers, model.markers().size());
}

TEST(GroundContact, AnotherModelStandsOnTheEndsOfItsLimbs) {
  const std::vector<ContactBody> bodies = ContactBodies(testing::Chain(3));
  EXPECT_THAT(Names(bodies), ElementsAre("link_3", "body"));
  EXPECT_THAT(bodies[0].segments, ElementsAre(3));
  EXPECT_THAT(bodies[1].segments, ElementsAre(0, 1, 2));
}

TEST(GroundContact, ARootThatIsOnlyANameTouchesNothing) {
  ModelDescription bare = DescriptionOf(testing::Chain(3));
  bare.segments[0].mass = 0;
  EXPECT_THAT(ContactBodies(KinematicModel(bare)).back().segments, ElementsAre(1, 2));
}

TEST(GroundContact, AnObjectIsOneBody) {
  const std::vector<ContactBody> bodies = ContactBodies(testing::Brick());
  EXPECT_THAT(Names(bodies), ElementsAre("body"));
  EXPECT_EQ(bodies[0].markers.size(), 8U);
}

/// A brick that stands on a floor at 0.7 m, slides with 2 m/s and then hovers.
TEST(GroundContact, TouchingIsLowAndSlow) {
  const KinematicModel model = testing::Brick();
  PoseTrajectory motion;
  motion.rate = 50;
  for (int k = 0; k < 90; ++k) {
    Posture q = ZeroPosture(model);
    q.position = {k < 60 ? 0.0 : 2 * (std::min(k, 75) - 60) / 50.0, 0, k < 80 ? 0.9 : 1.1};
    motion.postures.push_back(q);
  }
  const GroundContact contact = FindGroundContact(model, ContactBodies(model), motion, motion);
  EXPECT_NEAR(contact.ground_height, 0.7, 1e-12);
  EXPECT_EQ(contact.touches(0, 30), 1);
  EXPECT_EQ(contact.touches(0, 70), 0);
  EXPECT_EQ(contact.touches(0, 85), 0);
  EXPECT_NEAR(contact.heights(0, 70), 0, 1e-12);
  EXPECT_NEAR(contact.heights(0, 85), 0.2, 1e-12);
}

/// A brick on the ground, on a step of 0.3 m, and thrown up from there.
TEST(GroundContact, WhatRestsStandsOnSomethingAndWhatFallsDoesNot) {
  const KinematicModel model = testing::Brick();
  constexpr double kRate = 100, kStep = 0.3, kSpeed = 3;
  PoseTrajectory motion;
  motion.rate = kRate;
  for (int k = 0; k < 260; ++k) {
    Posture q = ZeroPosture(model);
    const double flown = std::max(0, k - 200) / kRate;
    q.position.z() = 0.2 + (k < 150 ? 0 : kStep) + kSpeed * flown - 0.5 * 9.81 * flown * flown;
    motion.postures.push_back(q);
  }
  const GroundContact contact = FindGroundContact(model, ContactBodies(model), motion, motion);
  EXPECT_NEAR(contact.ground_height, 0, 1e-12);
  EXPECT_EQ(contact.touches(0, 100), 1);
  EXPECT_EQ(contact.raised[100], 0);
  EXPECT_EQ(contact.touches(0, 175), 1);
  EXPECT_NEAR(contact.heights(0, 175), 0, 1e-9);
  EXPECT_NEAR(contact.raised[175], kStep, 1e-9);
  const int highest = 200 + static_cast<int>(std::lround(kRate * kSpeed / 9.81));
  EXPECT_EQ(contact.touches(0, highest), 0);
  EXPECT_EQ(contact.raised[highest], 0);
  EXPECT_NEAR(contact.heights(0, highest), kStep + kSpeed * kSpeed / 2 / 9.81, 1e-3);
}

TEST(GroundContact, DistanceFromAHull) {
  const std::vector<Vector2d> square = {{0, 0}, {1, 0}, {0.5, 0.5}, {1, 1}, {0, 1}, {0.5, 0}};
  EXPECT_EQ(DistanceOutsideHull(square, {0.3, 0.9}), 0);
  EXPECT_EQ(DistanceOutsideHull(square, {1, 0.5}), 0);
  EXPECT_DOUBLE_EQ(DistanceOutsideHull(square, {0.5, -0.2}), 0.2);
  EXPECT_DOUBLE_EQ(DistanceOutsideHull(square, {4, 5}), 5);
  const std::vector<Vector2d> line = {{0, 0}, {2, 0}, {1, 0}};
  EXPECT_DOUBLE_EQ(DistanceOutsideHull(line, {1, 0.5}), 0.5);
  EXPECT_DOUBLE_EQ(DistanceOutsideHull(line, {3, 0}), 1);
  EXPECT_DOUBLE_EQ(DistanceOutsideHull({{1, 1}}, {1, 3}), 2);
  EXPECT_DOUBLE_EQ(DistanceOutsideHull({{1, 1}, {1, 1}}, {1, 3}), 2);
}

}  // namespace
}  // namespace mmm_converter
