// SPDX-License-Identifier: MIT
#include "common/contacts/plate_readings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "common/forces/plate_checks.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

/// A walk along x over two plates: the left foot stands on the first in [0.5, 1.2) s, the right
/// foot on the second in [1.1, 1.8) s. The pressure moves from heel to toe, and forces point to the
/// body.
class PlateReadingsTest : public ::testing::Test {
 protected:
  static constexpr double kRate = 100;
  static constexpr double kSampleRate = 1000;
  static constexpr int kFrames = 300;
  static constexpr int kSamples = 3000;
  static constexpr double kFoot = 0.25;
  static constexpr double kWeight = 700;
  static constexpr double kNear = 1e-6;

  struct Stand {
    double begin, end, x, y;

    Eigen::Vector3d PressureAt(double t) const {
      return {x + kFoot * std::clamp((t - begin) / (end - begin), 0.0, 1.0), y, 0};
    }
  };
  static constexpr Stand kStands[] = {{0.5, 1.2, 0.2, 0.17}, {1.1, 1.8, 0.85, -0.13}};

  static Eigen::Vector3d BodyAt(double t) { return {t - 0.5, 0, 1}; }

  PlateReadingsTest() {
    motion_.rate = kRate;
    motion_.body.resize(3, kFrames);
    for (int k = 0; k < kFrames; ++k) motion_.body.col(k) = BodyAt(k / kRate);
    for (std::size_t side = 0; side < 2; ++side) {
      const Stand& stand = kStands[side];
      FootPath& foot = motion_.feet[side];
      foot.heel.resize(3, kFrames);
      foot.heel_speed.resize(kFrames);
      for (int k = 0; k < kFrames; ++k) {
        const double t = k / kRate;
        const bool stands = t >= stand.begin && t < stand.end;
        const double ahead = stands ? 0 : (t < stand.begin ? -2 : 2);
        foot.heel.col(k) = Eigen::Vector3d(stand.x + ahead, stand.y, stands ? 0 : 0.1);
        foot.heel_speed[k] = stands ? 0 : 3;
      }
      foot.toe = foot.heel;
      foot.toe.row(0).array() += kFoot;
      foot.toe_speed = foot.heel_speed;
    }
    forces_.rate = kSampleRate;
    for (int i = 0; i < 2; ++i) forces_.plates.push_back(MakePlate(i));
  }

  static ForcePlate TruePlate(int i) {
    ForcePlate plate;
    plate.number = i + 1;
    plate.channels = {0, 1, 2, 3, 4, 5};
    const Eigen::Vector3d middle(i == 0 ? 0.25 : 0.9, 0, 0);
    const Eigen::Vector3d x(0.3, 0, 0), y(0, -0.25, 0);  // of P, whose z points down
    plate.corners << middle + x + y, middle - x + y, middle - x - y, middle + x - y;
    EXPECT_TRUE(PlaceBetweenCorners(&plate));
    return plate;
  }

  static Eigen::Vector3d ForceAt(const Stand& stand, double t) {
    const Eigen::Vector3d way = BodyAt(t) - stand.PressureAt(t);
    return kWeight * way / way.z();
  }

  /// Of newtons and newton millimetres.
  static Eigen::MatrixXd MakeChannels(int i) {
    const ForcePlate plate = TruePlate(i);
    const Stand& stand = kStands[i];
    Eigen::MatrixXd channels = Eigen::MatrixXd::Zero(6, kSamples);
    for (int k = 0; k < kSamples; ++k) {
      const double t = k / kSampleRate;
      if (t < stand.begin || t >= stand.end) continue;
      const Eigen::Vector3d f = plate.R_WP.transpose() * ForceAt(stand, t);
      const Eigen::Vector3d p = plate.R_WP.transpose() * (stand.PressureAt(t) - plate.p_WP);
      channels.col(k) << f, 1e3 * p.cross(f);
    }
    return channels;
  }

  static PlateForces ReadPlate(const ForcePlate& plate, const Eigen::MatrixXd& channels) {
    PlateForces forces = ForcesOfPlate(plate, channels);
    forces.channels = channels;
    JudgeLoads(kSampleRate, &forces, nullptr);
    return forces;
  }

  static PlateForces MakePlate(int i) { return ReadPlate(TruePlate(i), MakeChannels(i)); }

  void ExpectTrue() const {
    for (std::size_t i = 0; i < 2; ++i) {
      const PlateForces& plate = forces_.plates[i];
      for (const double share : {0.2, 0.5, 0.8}) {
        const Stand& stand = kStands[i];
        const double t = stand.begin + share * (stand.end - stand.begin);
        const auto k = static_cast<Eigen::Index>(std::lround(t * kSampleRate));
        EXPECT_LT((plate.force.col(k) - ForceAt(stand, k / kSampleRate)).norm(), kNear);
        EXPECT_LT((plate.cop.col(k) - stand.PressureAt(k / kSampleRate)).norm(), kNear);
      }
      ASSERT_THAT(plate.loads, SizeIs(1));
    }
  }

  std::vector<std::string> Fit() { return FitPlatesToFeet(motion_, {}, &forces_, &warnings_); }

  FootMotion motion_;
  RecordedForces forces_;
  Warnings warnings_;
};

TEST_F(PlateReadingsTest, RightPlatesAreLeftAlone) {
  EXPECT_THAT(Fit(), IsEmpty());
  EXPECT_THAT(warnings_.texts(), IsEmpty());
  ExpectTrue();
}

TEST_F(PlateReadingsTest, AnyOrderOfCorners) {
  const std::array<int, 4> orders[] = {{2, 3, 0, 1}, {1, 2, 3, 0}, {3, 0, 1, 2}, {1, 0, 3, 2},
                                       {3, 2, 1, 0}, {0, 3, 2, 1}, {2, 1, 0, 3}};
  for (const auto& order : orders) {
    warnings_ = {};
    for (int i = 0; i < 2; ++i) {
      ForcePlate plate = TruePlate(i);
      for (int c = 0; c < 4; ++c) plate.corners.col(c) = TruePlate(i).corners.col(order[c]);
      ASSERT_TRUE(PlaceBetweenCorners(&plate));
      forces_.plates[i] = ReadPlate(plate, MakeChannels(i));
    }
    EXPECT_THAT(Fit(), IsEmpty());
    ASSERT_THAT(warnings_.texts(), SizeIs(2));
    EXPECT_THAT(warnings_.texts()[0], HasSubstr("corners in the order"));
    ExpectTrue();
  }
}

TEST_F(PlateReadingsTest, MomentsInNewtonMetresThatAreToldInMillimetres) {
  for (int i = 0; i < 2; ++i) {
    Eigen::MatrixXd channels = MakeChannels(i);
    channels.bottomRows(3) *= 1e-3;
    forces_.plates[i] = ReadPlate(TruePlate(i), channels);
  }
  EXPECT_THAT(Fit(), IsEmpty());
  ASSERT_FALSE(warnings_.texts().empty());
  EXPECT_THAT(warnings_.texts()[0], HasSubstr("moments in N m"));
  ExpectTrue();
}

TEST_F(PlateReadingsTest, MomentsOfOtherSignsOrderAndUnits) {
  const std::pair<const char*, std::array<double, 6>> signs[] = {
      {"Mx and My of the other sign", {1, 1, 1, -1, -1, 1}},
      {"Mx of the other sign", {1, 1, 1, -1, 1, 1}},
      {"moments in N cm", {1, 1, 1, 0.1, 0.1, 0.1}}};
  for (const auto& [told, factors] : signs) {
    warnings_ = {};
    for (int i = 0; i < 2; ++i) {
      Eigen::MatrixXd channels = MakeChannels(i);
      for (int row = 0; row < 6; ++row) channels.row(row) *= factors[row];
      forces_.plates[i] = ReadPlate(TruePlate(i), channels);
    }
    EXPECT_THAT(Fit(), IsEmpty()) << told;
    ASSERT_FALSE(warnings_.texts().empty()) << told;
    EXPECT_THAT(warnings_.texts()[0], HasSubstr(told));
    ExpectTrue();
  }
}

TEST_F(PlateReadingsTest, HorizontalForcesExchangedOrOfAnotherSign) {
  const auto exchange = [](Eigen::MatrixXd* channels) { channels->row(0).swap(channels->row(1)); };
  const auto turn = [](int row) {
    return [row](Eigen::MatrixXd* channels) { channels->row(row) *= -1; };
  };
  const std::pair<const char*, std::function<void(Eigen::MatrixXd*)>> faults[] = {
      {"Fx and Fy exchanged", exchange},
      {"Fx of the other sign", turn(0)},
      {"Fy of the other sign", turn(1)}};
  for (const auto& [told, spoil] : faults) {
    warnings_ = {};
    for (int i = 0; i < 2; ++i) {
      Eigen::MatrixXd channels = MakeChannels(i);
      spoil(&channels);
      forces_.plates[i] = ReadPlate(TruePlate(i), channels);
    }
    EXPECT_THAT(Fit(), IsEmpty()) << told;
    ASSERT_FALSE(warnings_.texts().empty()) << told;
    EXPECT_THAT(warnings_.texts()[0], HasSubstr(told));
    ExpectTrue();
  }
}

TEST_F(PlateReadingsTest, ForcesThatComeLateAreTold) {
  for (const int late : {150, -150}) {
    for (int i = 0; i < 2; ++i) {
      const Eigen::MatrixXd on_time = MakeChannels(i);
      Eigen::MatrixXd channels = Eigen::MatrixXd::Zero(6, kSamples);
      channels.middleCols(std::max(late, 0), kSamples - 150) =
          on_time.middleCols(std::max(-late, 0), kSamples - 150);
      forces_.plates[i] = ReadPlate(TruePlate(i), channels);
    }
    const std::vector<std::string> doubts = Fit();
    ASSERT_THAT(doubts, SizeIs(1));
    EXPECT_THAT(doubts[0], ContainsRegex("begin 1[45][0-9] ms and end 1[45][0-9] ms"));
    EXPECT_THAT(doubts[0], HasSubstr(late > 0 ? "later than the feet" : "earlier than the feet"));
  }
}

TEST_F(PlateReadingsTest, LoadsBeforeAndBehindTheMotionTellNothing) {
  for (FootPath& foot : motion_.feet) {
    foot.heel = foot.heel.middleCols(70, 60).eval();
    foot.toe = foot.toe.middleCols(70, 60).eval();
    foot.heel_speed = foot.heel_speed.segment(70, 60).eval();
    foot.toe_speed = foot.toe_speed.segment(70, 60).eval();
  }
  motion_.body = motion_.body.middleCols(70, 60).eval();
  motion_.first_time = 0.7;
  EXPECT_THAT(Fit(), IsEmpty());
  EXPECT_THAT(warnings_.texts(), IsEmpty());
  ExpectTrue();
}

TEST_F(PlateReadingsTest, APlateThatBearsNothingUnderAFootIsTold) {
  forces_.plates[1] = ReadPlate(TruePlate(1), 1e-3 * MakeChannels(1));
  EXPECT_THAT(Fit(), IsEmpty());
  ASSERT_THAT(warnings_.texts(), SizeIs(1));
  EXPECT_THAT(warnings_.texts()[0], HasSubstr("force plate 2: bears 0.7 N at most, but the right"));
}

TEST_F(PlateReadingsTest, ChannelsOfTwoPlatesExchanged) {
  forces_.plates[0] = ReadPlate(TruePlate(0), MakeChannels(1));
  forces_.plates[1] = ReadPlate(TruePlate(1), MakeChannels(0));
  EXPECT_THAT(Fit(), IsEmpty());
  ASSERT_FALSE(warnings_.texts().empty());
  EXPECT_THAT(warnings_.texts()[0], HasSubstr("exchanged"));
  ExpectTrue();
}

TEST_F(PlateReadingsTest, WhereNothingFitsNoFootBearsIt) {
  for (int i = 0; i < 2; ++i) {
    Eigen::MatrixXd channels = MakeChannels(i);
    channels.row(3) -= 0.4e3 * channels.row(2);  // 0.4 m aside
    channels.row(4) += 0.3e3 * channels.row(2);
    forces_.plates[i] = ReadPlate(TruePlate(i), channels);
  }
  const std::vector<std::string> doubts = Fit();
  ASSERT_THAT(doubts, SizeIs(2));
  EXPECT_THAT(doubts[0], HasSubstr("beside the foot that stands there"));
  for (const PlateForces& one : forces_.plates) EXPECT_THAT(one.loads, IsEmpty());
}

TEST_F(PlateReadingsTest, WhoIsNotSeenContradictsNoPlate) {
  for (int i = 0; i < 2; ++i) {
    Eigen::MatrixXd channels = MakeChannels(i);
    channels.bottomRows(3) *= -1;
    forces_.plates[i] = ReadPlate(TruePlate(i), channels);
  }
  KnownLegs hidden;
  for (auto& leg : hidden) leg.assign(kFrames, false);
  EXPECT_THAT(FitPlatesToFeet(motion_, hidden, &forces_, &warnings_), IsEmpty());
  EXPECT_THAT(warnings_.texts(), IsEmpty());
}

/// The same forces as a table has them.
class TableReadingsTest : public PlateReadingsTest {
 protected:
  TableReadingsTest() {
    for (std::size_t i = 0; i < 2; ++i) {
      forces_.plates[i].channels.resize(0, 0);
      forces_.plates[i].plate.p_WP.setZero();
      forces_.plates[i].applied_to = i == 0 ? "calcn_l" : "calcn_r";
    }
  }
};

TEST_F(TableReadingsTest, RightTablesAreLeftAlone) {
  EXPECT_THAT(Fit(), IsEmpty());
  EXPECT_THAT(warnings_.texts(), IsEmpty());
}

TEST_F(TableReadingsTest, PointsInMillimetres) {
  for (PlateForces& one : forces_.plates) one.cop *= 1e3;
  EXPECT_THAT(Fit(), IsEmpty());
  ASSERT_THAT(warnings_.texts(), SizeIs(1));
  EXPECT_THAT(warnings_.texts()[0], HasSubstr("points in mm"));
  ExpectTrue();
}

TEST_F(TableReadingsTest, TheOtherFoot) {
  std::swap(forces_.plates[0].applied_to, forces_.plates[1].applied_to);
  EXPECT_THAT(Fit(), IsEmpty());
  ASSERT_THAT(warnings_.texts(), SizeIs(1));
  EXPECT_EQ(forces_.plates[0].applied_to, "calcn_l");
}

}  // namespace
}  // namespace mmm_converter
