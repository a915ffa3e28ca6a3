// SPDX-License-Identifier: MIT
// Walkers who differ, whose markers, pressures and forces have errors that last, over plates whose
// files say something wrong.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "common/contacts/plate_readings.h"
#include "common/forces/plate_checks.h"
#include "common/math/statistics.h"

namespace mmm_converter {
namespace {

using ::testing::ElementsAre;

constexpr double kWalkFrameRate = 100, kWalkPlateRate = 1000;
constexpr int kWalkFrames = 300, kWalkSamples = 3000;
constexpr int kWalkers = 20;
constexpr int kFirstSeed = 21;  // the first 20 were looked at

/// A first-order process of standard deviation 1, whose errors last 0.1 s.
class LastingError {
 public:
  explicit LastingError(std::uint64_t seed) : random_(seed), value_(normal_(random_)) {}

  double Next(double rate) {
    const double stays = std::exp(-1 / (0.1 * rate));
    return value_ = stays * value_ + std::sqrt(1 - stays * stays) * normal_(random_);
  }

 private:
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  double value_;
};

/// Two steps, one on each of two plates, at an angle to them.
struct Walker {
  explicit Walker(std::uint64_t seed) {
    std::mt19937_64 random(seed);
    const auto draw = [&](double low, double high) {
      return std::uniform_real_distribution<double>(low, high)(random);
    };
    const double heading = draw(-0.4, 0.4) + (draw(0, 1) < 0.5 ? 0 : M_PI);
    ahead = {std::cos(heading), std::sin(heading), 0};
    aside = {-ahead.y(), ahead.x(), 0};
    speed = draw(0.7, 1.7);
    stance = draw(0.9, 1.1) * 0.75 / std::sqrt(speed);
    foot = draw(0.2, 0.27);
    width = draw(0.06, 0.14);
    weight = draw(350, 1100);
    first = draw(0, 1) < 0.5 ? 0 : 1;
    const double step = 0.85 * stance * speed;
    for (int i = 0; i < 2; ++i) {
      begin[i] = 0.6 + 0.85 * stance * i;
      const double side = (i == 0 ? first : 1 - first) == 0 ? 1 : -1;
      heel[i] = i * step * ahead + 0.5 * side * width * aside;
      middle[i] =
          heel[i] + 0.5 * foot * ahead + Eigen::Vector3d(draw(-0.05, 0.05), draw(-0.05, 0.05), 0);
      marker_error[i] = {draw(-0.015, 0.015), draw(-0.015, 0.015), 0};
    }
    body_error = {draw(-0.02, 0.02), draw(-0.02, 0.02), draw(-0.04, 0.04)};
    gain = draw(0.8, 1.2);
    noise = random();
  }

  Eigen::Vector3d BodyAt(double t) const {
    const double middle_time = begin[0] + 0.5 * stance;
    return heel[0] - (heel[0].dot(aside)) * aside + 0.5 * foot * ahead +
           speed * (t - middle_time) * ahead + Eigen::Vector3d(0, 0, 0.95);
  }

  Eigen::Vector3d ahead, aside;
  double speed = 0, stance = 0, foot = 0, width = 0, weight = 0, gain = 1;
  int first = 0;  ///< the side of the first step
  std::array<double, 2> begin = {};
  std::array<Eigen::Vector3d, 2> heel, middle, marker_error;
  Eigen::Vector3d body_error;
  std::uint64_t noise = 0;
};

ForcePlate PlateOf(const Walker& walker, int i) {
  ForcePlate plate;
  plate.number = i + 1;
  plate.channels = {0, 1, 2, 3, 4, 5};
  const Eigen::Vector3d x(0.3, 0, 0), y(0, -0.25, 0);  // of P, whose z points down
  const Eigen::Vector3d& middle = walker.middle[static_cast<std::size_t>(i)];
  plate.corners << middle + x + y, middle - x + y, middle - x - y, middle + x - y;
  EXPECT_TRUE(PlaceBetweenCorners(&plate));
  return plate;
}

/// What a plate measures: vertical force with two humps, horizontal force towards the body.
Eigen::MatrixXd ChannelsOf(const Walker& walker, int i) {
  const auto n = static_cast<std::size_t>(i);
  const ForcePlate plate = PlateOf(walker, i);
  std::array<LastingError, 4> errors = {
      LastingError(walker.noise + 1 + 10 * n), LastingError(walker.noise + 2 + 10 * n),
      LastingError(walker.noise + 3 + 10 * n), LastingError(walker.noise + 4 + 10 * n)};
  Eigen::MatrixXd channels = Eigen::MatrixXd::Zero(6, kWalkSamples);
  for (int k = 0; k < kWalkSamples; ++k) {
    const double t = k / kWalkPlateRate, share = (t - walker.begin[n]) / walker.stance;
    if (share <= 0 || share >= 1) continue;
    const double rise = std::min({1.0, share / 0.15, (1 - share) / 0.15});
    const double up = walker.weight * rise * (1 - 0.15 * std::cos(4 * M_PI * share));
    const Eigen::Vector3d p =
        walker.heel[n] + std::sqrt(share) * walker.foot * walker.ahead +
        0.004 * Eigen::Vector3d(errors[0].Next(kWalkPlateRate), errors[1].Next(kWalkPlateRate), 0);
    const Eigen::Vector3d way = walker.BodyAt(t) - p;
    Eigen::Vector3d f = up * way / way.z();
    f.head<2>() *= walker.gain;
    f.x() += 0.015 * up * errors[2].Next(kWalkPlateRate);
    f.y() += 0.015 * up * errors[3].Next(kWalkPlateRate);
    const Eigen::Vector3d f_P = plate.R_WP.transpose() * f;
    const Eigen::Vector3d p_P = plate.R_WP.transpose() * (p - plate.p_WP);
    channels.col(k) << f_P, 1e3 * p_P.cross(f_P);
  }
  return channels;
}

FootMotion MotionOf(const Walker& walker) {
  FootMotion motion;
  motion.rate = kWalkFrameRate;
  motion.body.resize(3, kWalkFrames);
  for (int k = 0; k < kWalkFrames; ++k) {
    motion.body.col(k) = walker.BodyAt(k / kWalkFrameRate) + walker.body_error;
  }
  for (int i = 0; i < 2; ++i) {
    const auto n = static_cast<std::size_t>(i);
    FootPath& foot =
        motion.feet[static_cast<std::size_t>(i == 0 ? walker.first : 1 - walker.first)];
    foot.heel.resize(3, kWalkFrames);
    foot.heel_speed.resize(kWalkFrames);
    LastingError error(walker.noise + 5 + 10 * n);
    for (int k = 0; k < kWalkFrames; ++k) {
      const double t = k / kWalkFrameRate;
      const double before = std::max(0.0, walker.begin[n] - t);
      const double after = std::max(0.0, t - walker.begin[n] - walker.stance);
      const bool stands = before == 0 && after == 0;
      foot.heel.col(k) = walker.heel[n] + walker.marker_error[n] +
                         2 * walker.speed * (after - before) * walker.ahead +
                         0.003 * error.Next(kWalkFrameRate) * walker.ahead;
      foot.heel(2, k) = stands ? 0 : 0.1;
      foot.heel_speed[k] = stands ? 0 : 2 * walker.speed;
    }
    foot.toe = foot.heel.colwise() + walker.foot * walker.ahead;
    foot.toe_speed = foot.heel_speed;
  }
  return motion;
}

using Channels = std::array<Eigen::MatrixXd, 2>;
/// What a file says wrong: of the plates and their channels.
using Fault = std::function<void(std::array<ForcePlate, 2>*, Channels*)>;

enum class Outcome { kRight, kTold, kSilent };

class PlateWalkersTest : public ::testing::Test {
 protected:
  /// How the file of a walker is read.
  static Outcome Read(const Walker& walker, const Fault& fault) {
    std::array<ForcePlate, 2> plates = {PlateOf(walker, 0), PlateOf(walker, 1)};
    const Channels truth = {ChannelsOf(walker, 0), ChannelsOf(walker, 1)};
    Channels channels = truth;
    fault(&plates, &channels);
    RecordedForces forces, right;
    forces.rate = right.rate = kWalkPlateRate;
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_TRUE(PlaceBetweenCorners(&plates[i]));
      forces.plates.push_back(ReadPlate(plates[i], channels[i]));
      right.plates.push_back(ReadPlate(PlateOf(walker, static_cast<int>(i)), truth[i]));
    }
    Warnings warnings;
    const auto doubts = FitPlatesToFeet(MotionOf(walker), {}, &forces, &warnings);
    if (!doubts.empty()) return Outcome::kTold;
    for (std::size_t i = 0; i < 2; ++i) {
      const PlateForces &read = forces.plates[i], &is = right.plates[i];
      if (read.loads.empty()) return warnings.empty() ? Outcome::kSilent : Outcome::kTold;
      std::vector<double> apart, beside;
      for (auto k = is.loads[0].begin; k < is.loads[0].end; ++k) {
        apart.push_back((read.force.col(k) - is.force.col(k)).norm());
        beside.push_back((read.cop.col(k) - is.cop.col(k)).norm());
      }
      const bool is_right = Median(apart) < 0.01 * walker.weight && Median(beside) < 0.01;
      if (!is_right) return Outcome::kSilent;
    }
    return Outcome::kRight;
  }

  /// Of walkers: how many files are read right, told to be wrong, or wrong without a word.
  static std::array<int, 3> Count(const Fault& fault) {
    std::array<int, 3> counts = {};
    for (int i = 0; i < kWalkers; ++i) {
      const Walker walker(static_cast<std::uint64_t>(kFirstSeed + i));
      ++counts[static_cast<std::size_t>(Read(walker, fault))];
    }
    return counts;
  }

  static PlateForces ReadPlate(const ForcePlate& plate, const Eigen::MatrixXd& channels) {
    PlateForces forces = ForcesOfPlate(plate, channels);
    forces.channels = channels;
    JudgeLoads(kWalkPlateRate, &forces, nullptr);
    return forces;
  }
};

Fault OfChannels(const std::function<void(Eigen::MatrixXd*)>& spoil) {
  return [spoil](std::array<ForcePlate, 2>*, Channels* channels) {
    for (Eigen::MatrixXd& one : *channels) spoil(&one);
  };
}

Fault OfCorners(const std::array<int, 4>& order) {
  return [order](std::array<ForcePlate, 2>* plates, Channels*) {
    for (ForcePlate& plate : *plates) {
      const auto corners = plate.corners;
      for (int c = 0; c < 4; ++c) plate.corners.col(c) = corners.col(order[c]);
    }
  };
}

/// The same of the first plate alone.
Fault OfFirst(const Fault& fault) {
  return [fault](std::array<ForcePlate, 2>* plates, Channels* channels) {
    const std::array<ForcePlate, 2> own_plates = *plates;
    const Channels own = *channels;
    fault(plates, channels);
    (*plates)[1] = own_plates[1];
    (*channels)[1] = own[1];
  };
}

Fault Late(int samples) {
  return OfChannels([samples](Eigen::MatrixXd* channels) {
    const Eigen::MatrixXd was = *channels;
    channels->setZero();
    channels->rightCols(was.cols() - samples) = was.leftCols(was.cols() - samples);
  });
}

TEST_F(PlateWalkersTest, RightPlatesAreLeftAlone) {
  EXPECT_THAT(Count([](std::array<ForcePlate, 2>*, Channels*) {}), ElementsAre(kWalkers, 0, 0));
}

TEST_F(PlateWalkersTest, WhatIsWrongIsReadRightOrTold) {
  const auto exchange = [](int a, int b) {
    return OfChannels(
        [a, b](Eigen::MatrixXd* channels) { channels->row(a).swap(channels->row(b)); });
  };
  const auto times = [](int first, int rows, double factor) {
    return OfChannels(
        [=](Eigen::MatrixXd* channels) { channels->middleRows(first, rows) *= factor; });
  };
  const Fault plates = [](std::array<ForcePlate, 2>*, Channels* c) { std::swap((*c)[0], (*c)[1]); };
  struct Case {
    const char* what;
    Fault fault;
    double least_right;      ///< of the walkers
    double most_silent = 0;  ///< where feet stand so near the plate's axis that 30 mm are wrong
  };
  const std::vector<Case> cases = {
      {"corners 2, 3, 4, 1", OfCorners({1, 2, 3, 0}), 0.9},
      {"corners 3, 4, 1, 2", OfCorners({2, 3, 0, 1}), 0.9},
      {"corners 4, 1, 2, 3", OfCorners({3, 0, 1, 2}), 0.9},
      {"corners 2, 1, 4, 3", OfCorners({1, 0, 3, 2}), 0.9},
      {"corners 4, 3, 2, 1", OfCorners({3, 2, 1, 0}), 0.9},
      {"corners 1, 4, 3, 2", OfCorners({0, 3, 2, 1}), 0.9},
      {"moments in N m", times(3, 3, 1e-3), 0.7},
      {"Mx of the other sign", times(3, 1, -1), 0.8, 0.2},
      {"Mx and My of the other sign", times(3, 2, -1), 0.9},
      {"Fx and Fy exchanged", exchange(0, 1), 0.9},
      {"Fx of the other sign", times(0, 1, -1), 0.9},
      {"Fy of the other sign", times(1, 1, -1), 0.9},
      {"Fx and Fy of the other sign", times(0, 2, -1), 0.9},
      {"the channels of the plates exchanged", plates, 0.9},
      {"forces in kN", times(0, 6, 1e-3), 0},
      {"forces 150 ms late", Late(150), 0},
      {"forces 100 ms late", Late(100), 0},
      {"corners 3, 4, 1, 2 of one plate", OfFirst(OfCorners({2, 3, 0, 1})), 0},
      {"Fx and Fy of one plate exchanged", OfFirst(exchange(0, 1)), 0},
      {"Mx and My of one plate of the other sign", OfFirst(times(3, 2, -1)), 0, 0.1}};
  for (const Case& one : cases) {
    const auto [right, told, silent] = Count(one.fault);
    EXPECT_GE(right, one.least_right * kWalkers) << one.what << ": " << told << " are told";
    EXPECT_LE(silent, one.most_silent * kWalkers) << one.what;
  }
}

}  // namespace
}  // namespace mmm_converter
