// SPDX-License-Identifier: MIT
#include "common/contacts/contacts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "common/contacts/contact_table.h"
#include "common/contacts/external_loads_writer.h"
#include "common/contacts/person_mass.h"
#include "common/forces/external_loads.h"
#include "common/forces/plate_checks.h"
#include "common/motion/slow_feet.h"
#include "common/support/atomic_file.h"
#include "common/support/error.h"
#include "tests/support/test_folder.h"

namespace mmm_converter {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using testing::TestFolder;

constexpr double kRate = 100;         // of frames
constexpr double kSampleRate = 1000;  // of plates
constexpr double kSeconds = 4;
constexpr double kFoot = 0.25;  // length
constexpr double kStep = 0.5;   // between the places where a foot stands
constexpr double kExact = 1e-9;

/// Two feet that step along x: the left stands in [0.5, 1.5) and [2, 3) s at x = 0.5 and 1.5, the
/// right in [1.3, 2.2) s at x = 1, and before and after these.
class WalkTest : public ::testing::Test {
 protected:
  struct Stand {
    double begin, end, x;
  };

  static void PutFoot(const std::vector<Stand>& stands, double y, FootPath* foot) {
    const auto frames = static_cast<Eigen::Index>(kSeconds * kRate);
    foot->heel.resize(3, frames);
    foot->heel_speed.resize(frames);
    for (Eigen::Index k = 0; k < frames; ++k) {
      const double t = static_cast<double>(k) / kRate;
      double x = 0;
      bool stands_there = false;
      for (const Stand& one : stands) {
        if (t >= one.begin) x = one.x;
        stands_there |= t >= one.begin && t < one.end;
      }
      foot->heel.col(k) =
          Eigen::Vector3d(x + (stands_there ? 0 : kStep), y, stands_there ? 0 : 0.1);
      foot->heel_speed[k] = stands_there ? 0 : 3;
    }
    foot->toe = foot->heel;
    foot->toe.row(0).array() += kFoot;
    foot->toe_speed = foot->heel_speed;
  }

  static FootMotion Walk() {
    FootMotion motion;
    motion.rate = kRate;
    PutFoot({{0.5, 1.5, 0.5}, {2, 3, 1.5}}, 0.1, &motion.feet[0]);
    PutFoot({{0, 0.6, 0}, {1.3, 2.2, 1}, {2.8, 4, 2}}, -0.1, &motion.feet[1]);
    return motion;
  }

  /// A level plate of 0.6 x 0.5 m around (x, y) that bears 700 N at (x, cop_y) in [begin, end) s.
  static PlateForces Plate(int number, double x, double y, double cop_y, double begin, double end) {
    const auto samples = static_cast<Eigen::Index>(kSeconds * kSampleRate);
    PlateForces plate;
    plate.plate.number = number;
    plate.plate.R_WP = Eigen::Vector3d(1, -1, -1).asDiagonal();
    plate.plate.p_WP = {x, y, 0};
    plate.plate.half_size = {0.3, 0.25};
    plate.force = Eigen::Matrix3Xd::Zero(3, samples);
    plate.cop = Eigen::Vector3d(x, cop_y, 0).replicate(1, samples);
    plate.free_moment = Eigen::Matrix3Xd::Zero(3, samples);
    plate.moment = plate.free_moment;
    for (auto k = static_cast<Eigen::Index>(begin * kSampleRate); k < end * kSampleRate; ++k) {
      plate.force.col(k) = Eigen::Vector3d(20, -10, 700);
      plate.free_moment.col(k).z() = 3;
    }
    JudgeLoads(kSampleRate, &plate, nullptr);
    return plate;
  }

  static RecordedForces ForcesOf(std::vector<PlateForces> plates) {
    RecordedForces forces;
    forces.rate = kSampleRate;
    forces.samples_per_frame = 10;
    forces.plates = std::move(plates);
    return forces;
  }

  static std::vector<FootContact> Of(Side side, const Contacts& contacts) {
    std::vector<FootContact> of;
    for (const FootContact& one : contacts.contacts) {
      if (one.side == side) of.push_back(one);
    }
    return of;
  }

  static constexpr double kLeftX = 0.5 + kFoot / 2;
  static constexpr double kRightX = 1 + kFoot / 2;
};

/// Two feet on two belts, along -y at speeds of their own: on the belt for `kStance` of each cycle,
/// then lifted by 100 mm and back.
class TreadmillTest : public WalkTest {
 protected:
  static constexpr double kCycle = 1.04;
  static constexpr double kStance = 0.62;

  static double BeginOf(std::size_t side) { return side == 0 ? 0.23 : 0.23 + kCycle / 2; }

  static FootMotion Treadmill(const std::array<double, 2>& speeds) {
    FootMotion motion;
    motion.rate = kRate;
    for (std::size_t side = 0; side < 2; ++side) {
      FootPath& foot = motion.feet[side];
      foot.heel.resize(3, static_cast<Eigen::Index>(kSeconds * kRate));
      const double way = speeds[side] * kStance * kCycle;
      for (Eigen::Index k = 0; k < foot.heel.cols(); ++k) {
        const double cycles = (static_cast<double>(k) / kRate - BeginOf(side)) / kCycle;
        const double share = cycles - std::floor(cycles);
        const double swing = std::max(0.0, (share - kStance) / (1 - kStance));
        const double turn = 2 * std::numbers::pi * swing;
        const double y = share < kStance ? way * (0.5 - share / kStance)
                                         : way * (swing - 0.5) - 0.2 * std::sin(turn);
        foot.heel.col(k) =
            Eigen::Vector3d(side == 0 ? -0.15 : 0.15, y, 0.05 * (1 - std::cos(turn)));
      }
      foot.toe = foot.heel;
      foot.toe.row(1).array() += kFoot;
    }
    FindSpeeds(&motion);
    return motion;
  }

  static void ExpectSteps(const Contacts& contacts, double within) {
    for (const Side side : kSides) {
      double begin = BeginOf(static_cast<std::size_t>(side));
      int found = 0;
      for (const FootContact& one : Of(side, contacts)) {
        if (!one.begin || !one.end || *one.begin < begin - kCycle / 2) continue;
        EXPECT_NEAR(*one.begin, begin, within) << Name(side);
        EXPECT_NEAR(*one.end, begin + kStance * kCycle, within) << Name(side);
        begin += kCycle;
        ++found;
      }
      EXPECT_GE(found, 2) << Name(side);
    }
  }
};

TEST_F(TreadmillTest, FeetStandWhereTheBeltCarriesThem) {
  for (const auto& speeds : {std::array{1.3, 1.3}, std::array{0.7, 1.4}, std::array{2.1, 2.1}}) {
    const FootMotion motion = Treadmill(speeds);
    for (std::size_t side = 0; side < 2; ++side) {
      EXPECT_NEAR(motion.feet[side].belt.y(), -speeds[side], 0.03);
    }
    ExpectSteps(FindContacts(motion, {}), 0.08);  // a made foot has no heel to stop it
  }
  EXPECT_EQ(Walk().feet[0].belt.norm(), 0);
}

TEST_F(TreadmillTest, EachBeltBearsItsFoot) {
  const FootMotion motion = Treadmill({1.3, 1.3});
  std::vector<PlateForces> belts = {Plate(1, -0.15, 0, 0, 5, 5), Plate(2, 0.15, 0, 0, 5, 5)};
  for (std::size_t side = 0; side < 2; ++side) {
    PlateForces& belt = belts[side];
    belt.plate.half_size = {0.14, 0.8};
    for (Eigen::Index i = 0; i < belt.force.cols(); ++i) {
      const double t = static_cast<double>(i) / kSampleRate;
      const double cycles = (t - BeginOf(side)) / kCycle;
      if (cycles - std::floor(cycles) < kStance) belt.force.col(i) = Eigen::Vector3d(5, 20, 700);
      const auto k = std::min(static_cast<Eigen::Index>(t * kRate), motion.feet[0].heel.cols() - 1);
      belt.cop.col(i) = motion.feet[side].heel.col(k) + Eigen::Vector3d(0.01, kFoot / 2, 0);
      belt.cop(2, i) = 0;
    }
    JudgeLoads(kSampleRate, &belt, nullptr);
  }
  const Contacts contacts = FindContacts(motion, ForcesOf(belts));
  ASSERT_GE(contacts.loads.size(), 6U);
  for (const PlateLoad& load : contacts.loads) {
    EXPECT_EQ(load.bearer, load.plate == 0 ? Bearer::kLeft : Bearer::kRight);
  }
  ExpectSteps(contacts, 0.002);
}

TEST(ContactLag, IsNoSurerThanAFootThatSlowsDownSlowlyUnlessItIsMeasured) {
  EXPECT_EQ(kBeginLag.DeviationOf(0.01), kBeginLag.deviation);
  EXPECT_EQ(kBeginLag.DeviationOf(0.1), 0.1);
  EXPECT_EQ((ContactLag{0.01, 0.005, 0, true}.DeviationOf(0.1)), 0.005);
}

TEST_F(WalkTest, WithoutPlatesFeetStandWhereTheyAreSlow) {
  const Contacts contacts = FindContacts(Walk(), {});
  EXPECT_THAT(contacts.loads, IsEmpty());
  const std::vector<FootContact> left = Of(Side::kLeft, contacts);
  ASSERT_THAT(left, SizeIs(2));
  EXPECT_NEAR(*left[0].begin, 0.5, 0.03);
  EXPECT_NEAR(*left[0].end, 1.5, 0.03);
  EXPECT_EQ(left[0].begin_deviation, 0.03);
  EXPECT_EQ(left[0].end_deviation, 0.02);
  const std::vector<FootContact> right = Of(Side::kRight, contacts);
  ASSERT_THAT(right, SizeIs(3));
  EXPECT_FALSE(right[0].begin);  // it stood there when the recording began
  EXPECT_FALSE(right[2].end);
}

TEST_F(WalkTest, TheCentreOfPressureTellsTheFoot) {
  const RecordedForces forces =
      ForcesOf({Plate(1, kLeftX, 0.1, 0.12, 0.52, 1.5), Plate(2, kRightX, -0.1, -0.13, 1.32, 2.2)});
  const Contacts contacts = FindContacts(Walk(), forces);
  ASSERT_THAT(contacts.loads, SizeIs(2));
  EXPECT_EQ(contacts.loads[0].bearer, Bearer::kLeft);
  EXPECT_NEAR(contacts.loads[0].distances[0], 0.02, kExact);
  EXPECT_EQ(contacts.loads[1].bearer, Bearer::kRight);
  const std::vector<FootContact> left = Of(Side::kLeft, contacts);
  ASSERT_THAT(left, SizeIs(2));
  EXPECT_THAT(left[0].plates, ElementsAre(1));
  EXPECT_EQ(*left[0].begin, 0.52);
  EXPECT_EQ(*left[0].end, 1.5);
  // Plates say of two steps that the load begins 30 ms later than the foot is slow: so elsewhere.
  EXPECT_THAT(left[1].plates, IsEmpty());
  EXPECT_NEAR(*left[1].begin, 2.02, 0.01);
}

TEST_F(WalkTest, AFootOverTwoPlatesIsOneContact) {
  const RecordedForces forces =
      ForcesOf({Plate(1, 0.55, 0.1, 0.1, 0.5, 1.45), Plate(2, 0.72, 0.1, 0.1, 0.55, 1.5)});
  const std::vector<FootContact> left = Of(Side::kLeft, FindContacts(Walk(), forces));
  ASSERT_THAT(left, SizeIs(2));
  EXPECT_THAT(left[0].plates, ElementsAre(1, 2));
  EXPECT_EQ(*left[0].begin, 0.5);
  EXPECT_EQ(*left[0].end, 1.5);
}

TEST_F(WalkTest, TwoFeetOnOnePlateHaveNoSide) {
  PlateForces plate = Plate(1, 0.8, 0, 0, 0.5, 2.2);
  plate.plate.half_size = {0.6, 0.4};
  const Contacts contacts = FindContacts(Walk(), ForcesOf({plate}));
  ASSERT_THAT(contacts.loads, SizeIs(1));
  EXPECT_EQ(contacts.loads[0].bearer, Bearer::kBoth);
  // Each stands there while it is slow.
  EXPECT_THAT(Of(Side::kLeft, contacts)[0].plates, ElementsAre(1));
  EXPECT_THAT(Of(Side::kRight, contacts)[1].plates, ElementsAre(1));
}

/// The left foot's heel and toes are at 0.5 and 0.75 m; it stands from 0.5 to 1.5 s, its heel
/// to 1.2.
TEST_F(WalkTest, AFootHalfBesideItsPlateComesAndGoesByItsMotion) {
  FootMotion walk = Walk();
  walk.feet[0].heel.row(2).segment(120, 30).setConstant(0.1);
  const PlateForces whole = Plate(2, kRightX, -0.1, -0.13, 1.32, 2.2);
  const auto find = [&](double middle, double begin, double end) {
    PlateForces part = Plate(1, middle, 0.1, 0.1, begin, end);
    part.cop.row(0).setConstant(kLeftX);
    return FindContacts(walk, ForcesOf({part, whole}));
  };
  const Contacts heel = find(0.9, 0.6, 1.5);  // from 0.6 m on
  ASSERT_THAT(heel.loads, SizeIs(2));
  EXPECT_TRUE(heel.loads[0].is_part_of_foot && heel.loads[0].begins_late);
  EXPECT_FALSE(heel.loads[0].ends_early || heel.loads[1].is_part_of_foot);
  EXPECT_NEAR(heel.loads[0].beside[0], 0.1, kExact);
  EXPECT_EQ(heel.loads[0].beside[1], 0);
  const std::vector<FootContact> by_heel = Of(Side::kLeft, heel);
  // The right foot's load begins 30 ms later than it is slow, which the late one does not change.
  EXPECT_NEAR(*by_heel[0].begin, 0.52, 0.01);
  EXPECT_GT(by_heel[0].begin_deviation, 0.01);
  EXPECT_EQ(*by_heel[0].end, 1.5);
  EXPECT_LT(by_heel[0].end_deviation, 0.01);
  EXPECT_THAT(by_heel[0].plates, ElementsAre(1));
  EXPECT_NEAR(*by_heel[1].begin, 2.02, 0.01);
  const Contacts toes = find(0.35, 0.5, 1.4);  // up to 0.65 m
  EXPECT_NEAR(toes.loads[0].beside[1], 0.1, kExact);
  EXPECT_TRUE(toes.loads[0].ends_early);
  EXPECT_NEAR(*Of(Side::kLeft, toes)[0].end, 1.5, 0.02);
  EXPECT_FALSE(find(0.82, 0.6, 1.5).loads[0].is_part_of_foot);  // 20 mm
  EXPECT_FALSE(find(0.41, 0.5, 1.4).loads[0].is_part_of_foot);  // 40 mm of toes
}

TEST_F(WalkTest, OpenSimsTableAppliesNoPartOfAFoot) {
  RecordedForces forces = ForcesOf({Plate(1, 0.9, 0.1, 0.1, 0.6, 1.5)});
  forces.plates[0].cop.row(0).setConstant(kLeftX);
  const Contacts contacts = FindContacts(Walk(), forces);
  const std::string xml = FormatExternalLoadsXml({&forces, &contacts, 0.5, 2}, "grf.mot");
  EXPECT_NE(xml.find("name=\"plate_1_left_part\""), std::string::npos) << xml;
  EXPECT_NE(xml.find("<appliesForce>false</appliesForce>"), std::string::npos) << xml;
}

TEST_F(WalkTest, WhatIsFarFromBothFeetIsUnknown) {
  const Contacts contacts = FindContacts(Walk(), ForcesOf({Plate(1, 0.6, 2, 2, 0.5, 1.5)}));
  EXPECT_EQ(contacts.loads[0].bearer, Bearer::kUnknown);
  EXPECT_THAT(Of(Side::kLeft, contacts)[0].plates, IsEmpty());
}

TEST_F(WalkTest, APlateThatTellsNoContactIsNotAsked) {
  PlateForces plate = Plate(1, kLeftX, 0.1, 0.12, 0.5, 1.5);
  plate.tells_contact = false;
  EXPECT_THAT(FindContacts(Walk(), ForcesOf({plate})).loads, IsEmpty());
}

TEST_F(WalkTest, TablesSayTheSame) {
  const RecordedForces forces = ForcesOf({Plate(1, kLeftX, 0.1, 0.12, 0.52, 1.5)});
  const Contacts contacts = FindContacts(Walk(), forces);
  const std::string csv = FormatContactsCsv(contacts);
  EXPECT_NE(csv.find("left,0.52,0.002,1.5,0.002,1\n"), std::string::npos) << csv;
  EXPECT_NE(csv.find("right,,,"), std::string::npos) << csv;
  const auto json = nlohmann::json::parse(FormatContactsJson(contacts, forces, {}));
  EXPECT_EQ(json["contacts"].size(), 5U);
  EXPECT_EQ(json["contacts"][0]["plates"], nlohmann::json({1}));
  EXPECT_EQ(json["loads"][0]["foot"], "left");
  ASSERT_EQ(json["events"].size(), 8U);  // two of ten are not within the recording
  EXPECT_EQ(json["events"][0]["label"], "Foot Strike");
  EXPECT_EQ(json["events"][0]["context"], "Left");
  EXPECT_EQ(json["events"][0]["time_s"], 0.52);
}

TEST_F(WalkTest, OpenSimsTableIsReadBackAsItWas) {
  const RecordedForces forces =
      ForcesOf({Plate(1, kLeftX, 0.1, 0.12, 0.52, 1.5), Plate(2, kRightX, -0.1, -0.13, 1.32, 2.2)});
  const Contacts contacts = FindContacts(Walk(), forces);
  const ExternalLoads loads = {&forces, &contacts, 0.5, 2};
  const std::string table = TestFolder() + "/grf.mot";
  WriteFileAtomically(table, FormatExternalLoadsTable(loads, "grf.mot"));
  for (const bool with_xml : {false, true}) {
    const std::string xml = TestFolder() + "/grf.xml";
    WriteFileAtomically(xml, FormatExternalLoadsXml(loads, "grf.mot"));
    const RecordedForces read =
        ReadExternalLoads(with_xml ? xml : table, Eigen::Vector3d::UnitY(), nullptr);
    ASSERT_THAT(read.plates, SizeIs(2));
    EXPECT_NEAR(read.first_time, 0.5, kExact);
    EXPECT_NEAR(read.rate, kSampleRate, 1e-6);
    EXPECT_EQ(read.plates[0].force.cols(), 1501);
    EXPECT_EQ(read.plates[0].applied_to, with_xml ? "calcn_l" : "ground_force_1_v");
    // y up: x, z, -y.
    EXPECT_EQ(read.plates[0].force.col(500), Eigen::Vector3d(20, 700, 10));
    EXPECT_EQ(read.plates[0].free_moment.col(500), Eigen::Vector3d(0, 3, 0));
    EXPECT_EQ(read.plates[1].cop.col(1000), Eigen::Vector3d(kRightX, 0, 0.13));
    // Unloaded: no force, the pressure where it was and where it will be.
    EXPECT_EQ(read.plates[1].force.col(0), Eigen::Vector3d::Zero());
    EXPECT_EQ(read.plates[1].cop.col(0), Eigen::Vector3d(kRightX, 0, 0.13));
    EXPECT_EQ(read.plates[0].cop.col(1400), Eigen::Vector3d(kLeftX, 0, -0.12));
    ASSERT_THAT(read.plates[1].loads, SizeIs(1));
    EXPECT_NEAR(read.time(read.plates[1].loads[0].begin), 1.32, kExact);
  }
}

TEST_F(WalkTest, TheBodyThatAFileNamesBearsItsPlate) {
  PlateForces plate = Plate(1, kLeftX, 0.1, 0.12, 0.5, 1.5);
  plate.applied_to = "calcn_r";
  EXPECT_EQ(FindContacts(Walk(), ForcesOf({plate})).loads[0].bearer, Bearer::kRight);
}

TEST_F(WalkTest, OpenSimCantUseALoadWithoutANumber) {
  RecordedForces forces = ForcesOf({Plate(1, kLeftX, 0.1, 0.12, 0.5, 1.5)});
  forces.plates[0].force.col(1000).setConstant(kNaN);
  const Contacts contacts = FindContacts(Walk(), forces);
  const ExternalLoads loads = {&forces, &contacts, 0, 3};
  EXPECT_THROW(Join(FormatExternalLoadsTable(loads, "grf.mot")), Error);
}

TEST_F(WalkTest, FromMidStanceToMidStanceThePlatesBearTheWeight) {
  // Two steps of 1 s whose loads overlap by 0.2 s, the sum always 686.7 N.
  PlateForces first = Plate(1, kLeftX, 0.1, 0.12, 0.5, 1.5);
  PlateForces second = Plate(2, kRightX, -0.1, -0.13, 1.3, 2.2);
  first.force.row(2).segment(500, 1000).setConstant(686.7);
  second.force.row(2).segment(1300, 900).setConstant(686.7);
  first.force.row(2).segment(1300, 200).setConstant(386.7);
  second.force.row(2).segment(1300, 200).setConstant(300);
  const RecordedForces forces = ForcesOf({first, second});
  const auto mass = EstimateMass(FindContacts(Walk(), forces), forces, Walk());
  ASSERT_TRUE(mass);
  EXPECT_NEAR(mass->mass, 70, 1e-6);
  EXPECT_GE(mass->intervals, 1);
  EXPECT_LT(mass->deviation, 1.5);
}

TEST_F(WalkTest, AFootBesideThePlatesTellsNoMass) {
  const RecordedForces forces = ForcesOf({Plate(1, kLeftX, 0.1, 0.12, 0.52, 1.5)});
  EXPECT_FALSE(EstimateMass(FindContacts(Walk(), forces), forces, Walk()));
}

}  // namespace
}  // namespace mmm_converter
