// SPDX-License-Identifier: MIT
#include "common/angles/gait_feet.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace mmm_converter {
namespace {

constexpr double kSameHere = 1e-9;  // rounding of a double
constexpr double kOut = 0.2;        // [rad] by which the toes of both feet point outwards

/// Feet that glide along a way at `heading`, turned outwards.
FootMotion FeetAlong(double heading) {
  FootMotion feet;
  feet.rate = 10;
  for (const Side side : kSides) {
    FootPath& foot = feet.feet[static_cast<std::size_t>(side)];
    const double turn = heading + (side == Side::kLeft ? kOut : -kOut);
    foot.heel.setZero(3, 21);
    foot.toe.setZero(3, 21);
    for (int k = 0; k < 21; ++k) {
      foot.heel.col(k) << 0.1 * k * std::cos(heading), 0.1 * k * std::sin(heading), 0;
      foot.toe.col(k) = foot.heel.col(k) + 0.2 * Eigen::Vector3d(std::cos(turn), std::sin(turn), 0);
    }
  }
  return feet;
}

Stride StrideFrom(Side side, double begin, double end) {
  Stride stride;
  stride.side = side;
  stride.begin = begin;
  stride.end = end;
  stride.foot_off = 0.6;
  stride.length = 1;
  return stride;
}

TEST(FootProgression, ToesInwardsArePositiveOnBothSidesWhateverTheWay) {
  for (const double heading : {0.0, 1.5, 3.1, -3.1}) {
    for (const Side side : kSides) {
      Stride stride = StrideFrom(side, 0.5, 1.5);
      stride.heading = heading;
      const GaitCycle cycle = FootProgression(FeetAlong(heading), stride);
      EXPECT_STREQ(cycle.angle.joint, "foot");
      EXPECT_STREQ(cycle.angle.side, Name(side));
      for (const double value : cycle.mean) EXPECT_NEAR(value, -kOut, kSameHere) << heading;
    }
  }
}

TEST(FootProgression, OnTheSpotThereIsNone) {
  Stride stride = StrideFrom(Side::kLeft, 0.5, 1.5);
  stride.length = 0;
  EXPECT_TRUE(std::isnan(FootProgression(FeetAlong(0), stride).mean[50]));
}

Contacts RightStands(std::vector<std::pair<std::optional<double>, std::optional<double>>> times) {
  Contacts contacts;
  for (const auto& [begin, end] : times) {
    FootContact contact;
    contact.side = Side::kRight;
    contact.begin = begin;
    contact.end = end;
    contacts.contacts.push_back(contact);
  }
  return contacts;
}

TEST(DoubleSupport, IsTheShareInWhichBothStand) {
  // The left foot stands from 1 to 2.2 s of a stride of 2 s.
  const Stride stride = StrideFrom(Side::kLeft, 1, 3);
  EXPECT_NEAR(DoubleSupport(stride, RightStands({{0, 1.2}, {2, 3.2}})), 0.2, kSameHere);
  EXPECT_NEAR(DoubleSupport(stride, RightStands({{{}, 1.2}, {2, {}}})), 0.2, kSameHere);
  EXPECT_EQ(DoubleSupport(stride, RightStands({{2.4, 2.8}})), 0);  // who runs
}

TEST(DoubleSupport, WithoutFootOffIsNotKnown) {
  Stride stride = StrideFrom(Side::kLeft, 1, 3);
  stride.foot_off = std::nan("");
  EXPECT_TRUE(std::isnan(DoubleSupport(stride, RightStands({{0, 1.2}}))));
}

TEST(MeanOf, StridesThatAreNotKnownThereDoNotCount) {
  std::vector<GaitCycle> strides(3);
  for (int i = 0; i < 3; ++i) strides[i].mean.fill(i);  // 0, 1, 2
  strides[2].mean[10] = std::nan("");
  const GaitCycle mean = MeanOf(strides);
  EXPECT_EQ(mean.strides, 3);
  EXPECT_NEAR(mean.mean[50], 1, kSameHere);
  EXPECT_NEAR(mean.deviation[50], 1, kSameHere);
  EXPECT_NEAR(mean.mean[10], 0.5, kSameHere);
  EXPECT_NEAR(mean.deviation[10], std::sqrt(0.5), kSameHere);
  EXPECT_TRUE(std::isnan(MeanOf({strides[2]}).mean[10]));
}

}  // namespace
}  // namespace mmm_converter
