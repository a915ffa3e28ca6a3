// SPDX-License-Identifier: MIT
#include "common/motion/foot_states.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/io/mmm/mmm_model.h"
#include "common/model/model_scaling.h"
#include "common/motion/slow_feet.h"
#include "common/motion/synthetic_motion.h"
#include "tests/support/shared_data.h"

namespace mmm_converter {
namespace {

constexpr double kFrameRate = 100;

/// Ends that rest 10 mm high over 60 frames; toes move as heels do.
PointState Resting() {
  PointState point;
  point.height = Eigen::VectorXd::Constant(60, 0.01);
  point.speed = Eigen::VectorXd::Constant(60, 0.1);
  return point;
}

std::array<FootRests, 2> RestsOf(const PointState& left, const PointState& right,
                                 const std::vector<FootContact>& contacts = {
                                     {Side::kLeft, {}, {}, 0, 0, {}},
                                     {Side::kRight, {}, {}, 0, 0, {}}}) {
  FootMotion motion;
  motion.rate = kFrameRate;
  for (FootPath& foot : motion.feet) foot.heel.resize(3, left.height.size());
  FootStates states;
  states.heels = states.toes = {left, right};
  return FindRests(motion, states, {contacts});
}

TEST(FootRests, AFootThatStaysLowIsNotOffForAMoment) {
  PointState low = Resting();
  low.speed.segment(20, 5).setConstant(0.9);
  PointState high = low;
  high.height.segment(20, 5).setConstant(0.07);
  const auto feet = RestsOf(low, high);
  ASSERT_EQ(feet[0].stances.size(), 1U);
  EXPECT_EQ(feet[0].stances[0].end, 60);
  ASSERT_EQ(feet[1].stances.size(), 2U);
  EXPECT_EQ(feet[1].stances[0].end, 20);
}

TEST(FootRests, AreWithinContacts) {
  const auto feet = RestsOf(Resting(), Resting(),
                            {{Side::kLeft, {}, 0.2, 0, 0, {}},
                             {Side::kLeft, 0.3, {}, 0, 0, {}},
                             {Side::kRight, 0.1, 0.4, 0, 0, {}}});
  ASSERT_EQ(feet[0].stances.size(), 2U);
  EXPECT_EQ(feet[0].stances[0].end, 21);
  EXPECT_EQ(feet[0].stances[1].begin, 30);
  ASSERT_EQ(feet[1].stances.size(), 1U);
  EXPECT_EQ(feet[1].stances[0].begin, 10);
  EXPECT_EQ(feet[1].stances[0].end, 41);
}

TEST(FootStates, AFootStandsOnStepsAndTheLowestIsTheFloor) {
  constexpr double kRise = 0.19;
  constexpr int kSteps = 4, kStands = 50, kSwings = 50;  // frames of each
  FootMotion motion;
  motion.rate = kFrameRate;
  // One foot stands while the other swings over two steps; one heel is 30 mm higher than the other.
  const int frames = kSteps * (kStands + kSwings);
  for (std::size_t i = 0; i < 2; ++i) {
    Eigen::Matrix3Xd path(3, frames);
    for (int k = 0; k < frames; ++k) {
      const int shifted = i == 0 ? k : std::max(k, kSwings) + kStands;
      const int done = shifted / (kStands + kSwings), within = shifted % (kStands + kSwings);
      const double part = std::max(0, within - kStands) / static_cast<double>(kSwings);
      const double lifted = 0.1 * std::sin(std::numbers::pi * part);
      path.col(k) << 0.6 * (done + part), 0, 2 * kRise * (done + part) + lifted;
    }
    if (i == 1) path.row(2).array() -= kRise;
    motion.feet[i].heel = motion.feet[i].toe = path;
    motion.feet[i].heel.row(2).array() += i == 0 ? 0.02 : 0.05;
    motion.feet[i].toe.row(0).array() += 0.2;
  }
  FindSpeeds(&motion);
  const FootStates states = FindFootStates(motion);
  const FootContacts contacts = FindSlowContacts(motion);
  const auto feet = FindRests(motion, states, contacts);
  for (std::size_t i = 0; i < 2; ++i) {
    const std::vector<FrameInterval>& stances = feet[i].stances;
    ASSERT_GE(stances.size(), 4U) << i;
    const auto of_foot =
        std::count_if(contacts.contacts.begin(), contacts.contacts.end(),
                      [&](const FootContact& one) { return one.side == kSides[i]; });
    EXPECT_EQ(of_foot, static_cast<std::ptrdiff_t>(stances.size()));  // without plates
    for (std::size_t n = 0; n < 4; ++n) {
      const double step = i == 0 ? 2.0 * static_cast<double>(n) : 2.0 * static_cast<double>(n) + 1;
      EXPECT_NEAR(states.support(i, stances[n].begin), kRise * step, 0.02) << i << " " << n;
    }
  }
}

TEST(FootStates, WhoeverStandsOnOneLegHoldsTheOtherFootUp) {
  const KinematicModel person =
      ScaleWinter(ReadMmmModel(testing::SourcePath("xml_config/models/mmm.xml")), {1.75, 70, {}});
  const FootStates states = FindFootStates(MoveFeet(person, MakeRaisedKnee(person)));
  double highest = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(states.supports[i].cwiseAbs().maxCoeff(), 0) << i;
    highest = std::max(highest, states.toes[i].height.maxCoeff());
  }
  EXPECT_GT(highest, 0.1);  // it is up
}

}  // namespace
}  // namespace mmm_converter
