// SPDX-License-Identifier: MIT
#include "common/contacts/plate_readings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/contacts/stance_fit.h"
#include "common/forces/plate_checks.h"
#include "common/forces/plate_forces.h"
#include "common/motion/foot_motion.h"
#include "common/support/units.h"
#include "common/support/warnings.h"

namespace mmm_converter {
namespace {

constexpr double kFitsAlike = 1e-3;  // [m] what fits alike is read by the simpler change

/// What a table of forces can mean. Default: what it says.
struct TableReading {
  double scale = 1;  ///< of its points
  int quarters = 0;  ///< turns of all about the vertical
  bool other_foot = false;
  std::vector<std::size_t> points;  ///< of which force each has the point; empty: its own

  std::size_t PointsOf(std::size_t force) const { return points.empty() ? force : points[force]; }
  std::string Describe() const {
    if (scale != 1) return fmt::format("points in {}", scale == 1e-3 ? "mm" : "cm");
    if (quarters != 0) {
      return fmt::format("all turned by {} degrees about the vertical", 90 * quarters);
    }
    return other_foot ? "the other foot" : "the points of the other force";
  }
};

class Table {
 public:
  Table(const FootMotion& motion, const KnownLegs& known, RecordedForces* forces)
      : feet_(motion, known, *forces), forces_(*forces) {
    for (const PlateForces& one : forces_.plates) {
      stances_.push_back(one.channels.size() == 0 && one.plate.has_moments
                             ? feet_.StancesOn(one, true)
                             : std::vector<Stance>());
    }
  }

  std::vector<std::string> Correct(Warnings* warnings) {
    const std::vector<double> own = DistancesOf({});
    const auto is_wrong = [&](double one) { return one > kBesideFoot; };
    if (std::none_of(own.begin(), own.end(), is_wrong)) return {};
    std::vector<TableReading> readings;
    const auto add = [&](auto change) {
      TableReading reading;
      change(&reading);
      readings.push_back(std::move(reading));
    };
    for (const double scale : {1e-3, 1e-2}) add([&](TableReading* one) { one->scale = scale; });
    for (const int turn : {1, 2, 3}) add([&](TableReading* one) { one->quarters = turn; });
    add([](TableReading* one) { one->other_foot = true; });
    const std::size_t count = forces_.plates.size();
    for (std::size_t i = 0; i < count && count <= 12; ++i) {
      for (std::size_t j = i + 1; j < count; ++j) {
        std::vector<std::size_t> points(count);
        std::iota(points.begin(), points.end(), std::size_t{0});
        std::swap(points[i], points[j]);
        add([&](TableReading* one) { one->points = points; });
      }
    }
    const TableReading* best = nullptr;
    double nearest = HUGE_VAL;
    for (const TableReading& one : readings) {
      const std::vector<double> distances = DistancesOf(one);
      if (distances.size() != own.size() || Max(distances) > kUnderFoot) continue;
      if (Mean(distances) < nearest - kFitsAlike) {
        nearest = Mean(distances);
        best = &one;
      }
    }
    if (best != nullptr) {
      Warn(warnings, fmt::format("the forces' points lie {} beside the feet that they act on; with "
                                 "{} they lie {:.0f} mm from them: taken so",
                                 Far(Max(own)), best->Describe(), kMillimetres * nearest));
      Take(*best);
      return {};
    }
    std::vector<std::string> doubts;
    for (std::size_t i = 0; i < count; ++i) {
      PlateForces& plate = forces_.plates[i];
      const double distance = DistanceOf(i, {});
      if (!(distance > kFarFromFoot)) continue;
      doubts.push_back(
          fmt::format("force {} ({}): its point lies {} beside the foot that stands; no unit, axis "
                      "or exchange puts it right; it is given to no foot",
                      plate.plate.number, plate.applied_to, Far(distance)));
      plate.tells_contact = false;
      plate.loads.clear();
    }
    return doubts;
  }

 private:
  static std::string Far(double distance) {
    return distance < 2 ? fmt::format("{:.0f} mm", kMillimetres * distance)
                        : fmt::format("{:.3g} m", distance);
  }

  static Eigen::Matrix3d TurnOf(const TableReading& reading) {
    return Eigen::AngleAxisd(reading.quarters * std::numbers::pi / 2, Eigen::Vector3d::UnitZ())
        .toRotationMatrix();
  }

  /// The mean of a force's stances; NaN: it has none.
  double DistanceOf(std::size_t i, const TableReading& reading) const {
    const PlateForces& plate = forces_.plates[i];
    Bearer bearer = BearerOfName(plate.applied_to);
    if (reading.other_foot && bearer != Bearer::kUnknown) {
      bearer = bearer == Bearer::kLeft ? Bearer::kRight : Bearer::kLeft;
    }
    const Eigen::Matrix3Xd& points = forces_.plates[reading.PointsOf(i)].cop;
    Fit fit;
    for (const Stance& stance : stances_[i]) {
      const Eigen::Matrix3Xd cop =
          reading.scale * TurnOf(reading) * points(Eigen::all, stance.samples);
      feet_.Measure(stance, plate.force(Eigen::all, stance.samples), cop, bearer, &fit);
    }
    return Median(fit.distances);
  }

  std::vector<double> DistancesOf(const TableReading& reading) const {
    std::vector<double> distances;
    for (std::size_t i = 0; i < stances_.size(); ++i) {
      const double one = DistanceOf(i, reading);
      if (!std::isnan(one)) distances.push_back(one);
    }
    return distances;
  }

  void Take(const TableReading& reading) {
    std::vector<PlateForces> read = forces_.plates;
    const Eigen::Matrix3d R = TurnOf(reading);
    for (std::size_t i = 0; i < read.size(); ++i) {
      if (forces_.plates[i].channels.size() > 0) continue;
      read[i].cop = reading.scale * R * forces_.plates[reading.PointsOf(i)].cop;
      read[i].force = R * read[i].force;
      read[i].free_moment = R * read[i].free_moment;
      for (Eigen::Index k = 0; k < read[i].cop.cols(); ++k) {
        const Eigen::Vector3d p = read[i].cop.col(k) - read[i].plate.p_WP;
        read[i].moment.col(k) = p.cross(Eigen::Vector3d(read[i].force.col(k)));
      }
      read[i].moment += read[i].free_moment;
      const Bearer bearer = BearerOfName(read[i].applied_to);
      if (reading.other_foot && bearer != Bearer::kUnknown) {
        read[i].applied_to = bearer == Bearer::kLeft ? "calcn_r" : "calcn_l";
      }
    }
    forces_.plates = std::move(read);
  }

  StanceFeet feet_;
  RecordedForces& forces_;
  std::vector<std::vector<Stance>> stances_;
};

/// FitPlatesToFeet of forces that a table holds.
std::vector<std::string> FitTableToFeet(const FootMotion& motion, const KnownLegs& known,
                                        RecordedForces* forces, Warnings* warnings) {
  return Table(motion, known, forces).Correct(warnings);
}

constexpr double kNearer = 0.6;  // of the distance as the file says it
// Another reading, where the file's is not far: of 29 right plates none is nearer than 0.75 of it.
constexpr double kMuchNearer = 0.4;
constexpr double kTellingDistance = 0.03;  // [m] of what is to be so much nearer
constexpr double kDistinct = 0.01;         // [m] between the best reading and the next one
constexpr double kLongStand = 0.3;         // [s] of a foot on a plate
constexpr double kOnPlate = 0.08;          // [m] between a plate and the toes on it
// Cosine between the forces and the ways to the body: right plates of 13 recordings have 0.44 to
// 0.94, and at least 0.22 less with exchanged horizontal forces.
constexpr double kElsewhere = 0.35;
constexpr double kMoreTowards = 0.15;

constexpr std::array<std::array<int, 4>, 8> kOrders = {{{0, 1, 2, 3},
                                                        {2, 3, 0, 1},
                                                        {1, 2, 3, 0},
                                                        {3, 0, 1, 2},
                                                        {1, 0, 3, 2},
                                                        {3, 2, 1, 0},
                                                        {0, 3, 2, 1},
                                                        {2, 1, 0, 3}}};

/// What channels can be beside what a file says: three forces and three moments times it.
struct Exchange {
  const char* name = "";
  Eigen::Matrix<double, 6, 6> matrix;
};

Exchange Diagonal(const char* name, const Eigen::Matrix<double, 6, 1>& diagonal) {
  return {name, diagonal.asDiagonal()};
}

Exchange Swap(const char* name, int a, int b) {
  Exchange exchange = {name, Eigen::Matrix<double, 6, 6>::Identity()};
  exchange.matrix.row(a).swap(exchange.matrix.row(b));
  return exchange;
}

const std::vector<Exchange>& Exchanges() {
  using Six = Eigen::Matrix<double, 6, 1>;
  static const std::vector<Exchange> all = {
      Diagonal("Mx and My of the other sign", Six{1, 1, 1, -1, -1, 1}),
      Diagonal("Mx of the other sign", Six{1, 1, 1, -1, 1, 1}),
      Diagonal("My of the other sign", Six{1, 1, 1, 1, -1, 1}),
      Swap("Mx and My exchanged", 3, 4),
      Swap("Fx and Fy exchanged", 0, 1),
      Diagonal("Fx of the other sign", Six{-1, 1, 1, 1, 1, 1}),
      Diagonal("Fy of the other sign", Six{1, -1, 1, 1, 1, 1}),
      Diagonal("Fx and Fy of the other sign", Six{-1, -1, 1, 1, 1, 1})};
  return all;
}

const Exchange& ExchangedHorizontally() { return Exchanges()[4]; }

/// What a plate's file can mean. Default: what it says.
struct Reading {
  std::size_t order = 0;
  double unit = 0;  ///< of moments [N m]; 0: the file's
  bool reverses_origin = false;
  bool turns_polynomial = false, drops_polynomial = false;
  const Exchange* exchange = nullptr;
  std::vector<std::size_t> sources;  ///< the plate whose channels each has; empty: its own

  /// In how many things it differs from what the file says.
  int Changes() const {
    return (order != 0) + (unit > 0) + reverses_origin + (exchange != nullptr) + turns_polynomial +
           drops_polynomial + !sources.empty();
  }
  std::size_t SourceOf(std::size_t plate) const { return sources.empty() ? plate : sources[plate]; }
};

/// The plate with the channels of `source`, as a reading has it.
ForcePlate Read(const Reading& reading, const ForcePlate& plate, const ForcePlate& source) {
  ForcePlate read = source;
  read.number = plate.number;
  read.corners = plate.corners;
  read.R_WP = plate.R_WP;
  read.p_WP = plate.p_WP;
  read.half_size = plate.half_size;
  if (reading.order != 0) {
    for (int c = 0; c < 4; ++c) read.corners.col(c) = plate.corners.col(kOrders[reading.order][c]);
    PlaceBetweenCorners(&read);
  }
  if (reading.unit > 0) read.moment_unit = reading.unit;
  if (reading.reverses_origin) read.origin *= -1;
  if (reading.exchange != nullptr) {
    Eigen::Matrix<double, 6, 6> matrix = Eigen::Matrix<double, 6, 6>::Identity();
    matrix.topRows<3>() *= read.force_unit;
    if (read.type == PlateType::kCalibratedChannels) matrix = *read.calibration;
    read.type = PlateType::kCalibratedChannels;
    read.calibration = reading.exchange->matrix * matrix;
  }
  if (reading.drops_polynomial) read.cop_polynomial.reset();
  if (reading.turns_polynomial && read.cop_polynomial) {
    const Eigen::Matrix<double, 6, 2> stored = *read.cop_polynomial;
    read.cop_polynomial = Eigen::Map<const Eigen::Matrix<double, 2, 6>>(stored.data()).transpose();
  }
  return read;
}

std::string Describe(const Reading& reading) {
  std::vector<std::string> texts;
  if (reading.order != 0) {
    const auto& order = kOrders[reading.order];
    texts.push_back(fmt::format("corners in the order {}, {}, {}, {}", order[0] + 1, order[1] + 1,
                                order[2] + 1, order[3] + 1));
  }
  if (reading.unit > 0) {
    const char* name = reading.unit == 1 ? "N m" : reading.unit == 1e-2 ? "N cm" : "N mm";
    texts.push_back(fmt::format("moments in {}", name));
  }
  if (reading.reverses_origin) texts.emplace_back("ORIGIN reversed");
  if (reading.exchange != nullptr) texts.emplace_back(reading.exchange->name);
  if (reading.drops_polynomial) texts.emplace_back("no FPCOPPOLY");
  if (reading.turns_polynomial) texts.emplace_back("FPCOPPOLY stored as 2 x 6");
  if (!reading.sources.empty()) texts.emplace_back("the channels of the plates exchanged");
  return fmt::format("{}", fmt::join(texts, " and "));
}

/// Readings that differ in one thing, then those that differ in two. may_exchange: channels, too.
std::vector<Reading> OtherReadings(const RecordedForces& forces,
                                   const std::vector<std::size_t>& plates, bool may_exchange) {
  std::vector<Reading> single(kOrders.size() - 1);
  for (std::size_t i = 0; i < single.size(); ++i) single[i].order = i + 1;
  const auto has = [&](auto is_so) {
    return std::any_of(plates.begin(), plates.end(),
                       [&](std::size_t i) { return is_so(forces.plates[i].plate); });
  };
  const auto add = [&](auto change) {
    Reading reading;
    change(&reading);
    single.push_back(reading);
  };
  const bool has_moments = has([](const ForcePlate& one) {
    return one.type == PlateType::kForcesAndMoments || one.type == PlateType::kCalibratedChannels;
  });
  for (const double unit : {1.0, 1e-3, 1e-2}) {
    const bool is_other = has([&](const ForcePlate& one) { return one.moment_unit != unit; });
    if (has_moments && is_other) add([&](Reading* one) { one->unit = unit; });
  }
  if (has_moments) {
    add([](Reading* one) { one->reverses_origin = true; });
    for (const Exchange& exchange : Exchanges()) {
      add([&](Reading* one) { one->exchange = &exchange; });
    }
  }
  if (has([](const ForcePlate& one) { return one.cop_polynomial.has_value(); })) {
    add([](Reading* one) { one->turns_polynomial = true; });
    add([](Reading* one) { one->drops_polynomial = true; });
  }
  const std::size_t count = forces.plates.size();
  std::vector<std::vector<std::size_t>> exchanges;
  std::vector<std::size_t> own(count);
  std::iota(own.begin(), own.end(), std::size_t{0});
  if (may_exchange && count > 1 && count <= 4) {
    std::vector<std::size_t> next = own;
    while (std::next_permutation(next.begin(), next.end())) exchanges.push_back(next);
  } else if (may_exchange && count > 1 && count <= 12) {
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t j = i + 1; j < count; ++j) {
        exchanges.push_back(own);
        std::swap(exchanges.back()[i], exchanges.back()[j]);
      }
    }
  }
  for (const auto& sources : exchanges) add([&](Reading* one) { one->sources = sources; });
  std::vector<Reading> all = single;
  for (std::size_t order = 1; order < kOrders.size(); ++order) {
    for (const Reading& one : single) {
      if (one.order != 0) continue;
      all.push_back(one);
      all.back().order = order;
    }
  }
  return all;
}

class Plates {
 public:
  Plates(const FootMotion& motion, const KnownLegs& known, RecordedForces* forces)
      : feet_(motion, known, *forces), forces_(*forces) {
    for (std::size_t i = 0; i < forces_.plates.size(); ++i) {
      const PlateForces& one = forces_.plates[i];
      const bool is_readable = one.channels.size() > 0 && one.plate.has_moments;
      stances_.push_back(is_readable ? feet_.StancesOn(one, false) : std::vector<Stance>());
      if (!stances_.back().empty()) loaded_.push_back(i);
      if (is_readable) own_.push_back(i);
    }
  }

  std::vector<std::string> Correct(Warnings* warnings) {
    std::vector<std::size_t> wrong = Contradicted();
    if (wrong.empty()) return {};
    if (const auto found = Choose(loaded_, OtherReadings(forces_, own_, true))) {
      Take(*found, own_, warnings);
      return {};
    }
    std::vector<std::string> doubts;
    for (const std::size_t i : wrong) {
      if (const auto found = Choose({i}, OtherReadings(forces_, {i}, false))) {
        Take(*found, {i}, warnings);
      } else {
        Refuse(i, &doubts, warnings);
      }
    }
    return doubts;
  }

 private:
  Fit FitOf(std::size_t plate, const Reading& reading) const {
    const std::size_t from = reading.SourceOf(plate);
    const PlateForces& source = forces_.plates[from];
    Fit fit;
    if (source.channels.size() == 0 || source.plate.type != forces_.plates[plate].plate.type) {
      return fit;
    }
    const ForcePlate read = Read(reading, forces_.plates[plate].plate, source.plate);
    // Forces times ORIGIN move the pressure of moments that are a thousand times too small.
    ForcePlate by_moments = read;
    if (read.type != PlateType::kEightForces) by_moments.origin.setZero();
    Fit without_origin;
    for (const Stance& stance : stances_[from]) {
      const Eigen::MatrixXd channels = source.channels(Eigen::all, stance.samples);
      PlateForces of = ForcesOfPlate(read, channels);
      if (source.is_reversed) of.force *= -1;
      feet_.Measure(stance, of.force, of.cop, Bearer::kUnknown, &fit);
      of = ForcesOfPlate(by_moments, channels);
      feet_.Measure(stance, of.force, of.cop, Bearer::kUnknown, &without_origin);
    }
    fit.travel = std::min(fit.travel, without_origin.travel);
    return fit;
  }

  /// Why the file can't be right; empty: it can.
  std::string WhyNot(std::size_t plate, const Fit& fit) const {
    const double normal = forces_.plates[plate].plate.R_WP(2, 2);
    if (!fit.IsUp() && std::abs(normal) > 0.5) return "its forces pull the person down";
    if (Median(fit.distances) > kBesideFoot) {
      return fmt::format("its centre of pressure lies {:.0f} mm beside the foot that stands there",
                         kMillimetres * Median(fit.distances));
    }
    if (fit.travel < kStillPressure)
      return "its centre of pressure stands still for a whole stance";
    if (fit.Retreats()) return "its centre of pressure moves against the person";
    if (fit.LeansAway()) return "its forces lean away from the person";
    if (LeansElsewhere(plate, fit)) return "its forces do not lean to the person";
    if (IsMuchNearerOtherwise(plate, fit)) {
      return fmt::format("its centre of pressure lies {:.0f} mm from the foot",
                         kMillimetres * fit.mean());
    }
    return "";
  }

  /// Whether horizontal forces point to the person only when they are exchanged.
  bool LeansElsewhere(std::size_t plate, const Fit& own) const {
    if (forces_.plates[plate].plate.type == PlateType::kEightForces) return false;
    Reading exchanged;
    exchanged.exchange = &ExchangedHorizontally();
    const double towards = FitOf(plate, exchanged).Towards();
    return towards > kElsewhere && towards > own.Towards() + kMoreTowards;
  }

  bool IsMeasured(std::size_t plate, const Fit& fit) const {
    return fit.IsUp() && fit.travel >= kStillPressure && !fit.LeansAway() && !fit.Retreats() &&
           !LeansElsewhere(plate, fit);
  }

  /// Whether the pressure comes much nearer to the feet where one thing is read otherwise: where a
  /// foot stands near the middle of a plate, moments of another sign or unit are not far beside it.
  bool IsMuchNearerOtherwise(std::size_t plate, const Fit& own) const {
    if (forces_.plates[plate].plate.type == PlateType::kEightForces) return false;
    if (!(own.mean() > kTellingDistance)) return false;
    const std::vector<Reading> readings = OtherReadings(forces_, {plate}, false);
    return std::any_of(readings.begin(), readings.end(), [&](const Reading& one) {
      if (one.Changes() > 1) return false;
      const Fit fit = FitOf(plate, one);
      return fit.IsGood() && fit.mean() < kMuchNearer * own.mean();
    });
  }

  std::vector<std::size_t> Contradicted() {
    std::vector<std::size_t> wrong;
    for (const std::size_t i : loaded_) {
      if (!WhyNot(i, FitOf(i, {})).empty()) wrong.push_back(i);
    }
    return wrong;
  }

  /// How far the pressure of these plates lies from the feet as they are read, on average, and how
  /// well the forces point to the body. Nothing: they are not measured so.
  std::optional<std::pair<double, double>> Agreement(const std::vector<std::size_t>& plates,
                                                     const Reading& reading) const {
    double sum = 0, count = 0, towards = 1;
    for (const std::size_t i : plates) {
      if (stances_[reading.SourceOf(i)].empty()) continue;
      const Fit fit = FitOf(i, reading);
      if (!fit.IsGood() || fit.Towards() < kElsewhere) return {};
      sum += fit.mean();
      towards = std::min(towards, fit.Towards());
      ++count;
    }
    if (count == 0) return {};
    return std::pair(sum / count, towards);
  }

  /// The reading of these plates that fits best, where no other fits nearly as well; of those whose
  /// pressure is as near, the one whose forces point to the body. Those that differ in two things
  /// count where none does that differs in one.
  std::optional<Reading> Choose(const std::vector<std::size_t>& plates,
                                const std::vector<Reading>& readings) const {
    bool is_beside = false;
    double own = 0;
    std::size_t stances = 0;
    for (const std::size_t i : plates) {
      const Fit fit = FitOf(i, {});
      own += fit.mean() / static_cast<double>(plates.size());
      is_beside |= IsMeasured(i, fit);
      stances += stances_[i].size();
    }
    if (stances < 2) return std::nullopt;  // one agrees with too much
    struct Candidate {
      const Reading* reading;
      double distance, towards;
    };
    for (const bool changes_two : {false, true}) {
      std::vector<Candidate> all;
      for (const Reading& one : readings) {
        if (changes_two != (one.Changes() > 1)) continue;
        if (const auto found = Agreement(plates, one)) {
          all.push_back({&one, found->first, found->second});
        }
      }
      if (all.empty()) continue;
      std::sort(all.begin(), all.end(),
                [](const Candidate& a, const Candidate& b) { return a.distance < b.distance; });
      const double least = all.front().distance;
      std::erase_if(all, [&](const Candidate& one) { return one.distance > least + kDistinct; });
      std::stable_sort(all.begin(), all.end(), [](const Candidate& a, const Candidate& b) {
        return a.towards > b.towards;
      });
      const Candidate& best = all.front();
      if (best.distance > (is_beside ? kNearer * own : kUnderFoot)) continue;
      if (all.size() > 1 && best.towards < all[1].towards + kMoreTowards) continue;
      return *best.reading;
    }
    return std::nullopt;
  }

  void Take(const Reading& reading, const std::vector<std::size_t>& plates, Warnings* warnings) {
    std::vector<std::string> why(forces_.plates.size());
    std::vector<double> distances(forces_.plates.size(), kNaN);
    std::vector<PlateForces> read = forces_.plates;
    for (const std::size_t i : plates) {
      if (!stances_[i].empty()) why[i] = WhyNot(i, FitOf(i, {}));
      const PlateForces& source = forces_.plates[reading.SourceOf(i)];
      distances[i] = FitOf(i, reading).mean();
      read[i] =
          ForcesOfPlate(Read(reading, forces_.plates[i].plate, source.plate), source.channels);
      read[i].channels = source.channels;
      read[i].clipped = source.clipped;
      if (source.moment.array().isNaN().all()) read[i].moment.setConstant(kNaN);
      JudgeLoads(forces_.rate, &read[i], nullptr);
    }
    for (const std::size_t i : plates) {
      if (why[i].empty() && std::isnan(distances[i])) continue;
      Warn(warnings, fmt::format("force plate {}: {}; with {} it lies {:.0f} mm from it: taken so",
                                 forces_.plates[i].plate.number,
                                 why[i].empty() ? "is read as the others are"
                                                : "as the file has it " + why[i],
                                 Describe(reading), kMillimetres * distances[i]));
    }
    forces_.plates = std::move(read);
  }

  void Refuse(std::size_t i, std::vector<std::string>* doubts, Warnings* warnings) {
    PlateForces& plate = forces_.plates[i];
    const Fit fit = FitOf(i, {});
    if (IsMeasured(i, fit) && Median(fit.distances) <= kFarFromFoot) {  // a foot half beside it
      Warn(warnings, fmt::format("force plate {}: {}; it is kept as the file has it",
                                 plate.plate.number, WhyNot(i, fit)));
      return;
    }
    doubts->push_back(
        fmt::format("force plate {}: {}, and no order of corners, unit of moments or exchange of "
                    "channels puts it right; its forces are given to no foot",
                    plate.plate.number, WhyNot(i, fit)));
    plate.tells_contact = false;
    plate.loads.clear();
  }

  StanceFeet feet_;
  RecordedForces& forces_;
  std::vector<std::vector<Stance>> stances_;
  std::vector<std::size_t> loaded_, own_;
};

/// The first time that a foot stands with heel and toes on a plate.
std::optional<std::pair<Side, SlowFoot>> StandsOn(const ForcePlate& plate, const FootMotion& motion,
                                                  const SlowFeet& slow) {
  for (const Side side : kSides) {
    const FootPath& foot = motion.foot(side);
    for (const SlowFoot& one : slow[static_cast<std::size_t>(side)]) {
      const auto k = static_cast<Eigen::Index>(std::lround((one.begin + one.end) / 2));
      if (one.end - one.begin > kLongStand * motion.rate && IsOver(plate, foot.heel.col(k)) &&
          IsOver(plate, foot.toe.col(k)) && std::abs(foot.toe(2, k) - plate.p_WP.z()) < kOnPlate) {
        return std::pair(side, one);
      }
    }
  }
  return std::nullopt;
}

/// Says of plates that bear nobody while a foot stands on them.
void WarnOfDeadPlates(const FootMotion& motion, const RecordedForces& forces, Warnings* warnings) {
  std::optional<SlowFeet> slow;
  for (const PlateForces& plate : forces.plates) {
    if (!plate.loads.empty() || !plate.tells_contact || !(plate.plate.half_size.minCoeff() > 0)) {
      continue;
    }
    if (!slow) slow = FindSlowFeet(motion);
    const auto stands = StandsOn(plate.plate, motion, *slow);
    if (!stands) continue;
    const auto& [side, times] = *stands;
    Warn(warnings,
         fmt::format("force plate {}: bears {:.3g} N at most, but the {} foot stands on it from "
                     "{:.2f} to {:.2f} s: it was off, or its forces are in another unit",
                     plate.plate.number, plate.largest_load, Name(side), motion.time(times.begin),
                     motion.time(times.end)));
  }
}

}  // namespace

std::vector<std::string> FitPlatesToFeet(const FootMotion& motion, const KnownLegs& known,
                                         RecordedForces* forces, Warnings* warnings) {
  if (forces->plates.empty() || motion.num_frames() < 3) return {};
  const bool is_table = forces->plates.front().channels.size() == 0;
  const std::string late = StanceFeet(motion, known, *forces).Lateness();
  if (!late.empty()) return {late};
  if (is_table) return FitTableToFeet(motion, known, forces, warnings);
  std::vector<std::string> doubts = Plates(motion, known, forces).Correct(warnings);
  if (doubts.empty()) WarnOfDeadPlates(motion, *forces, warnings);
  return doubts;
}

}  // namespace mmm_converter
