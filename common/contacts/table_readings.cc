// SPDX-License-Identifier: MIT
#include "common/contacts/table_readings.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "common/contacts/stance_fit.h"
#include "common/support/units.h"

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

}  // namespace

std::vector<std::string> FitTableToFeet(const FootMotion& motion, const KnownLegs& known,
                                        RecordedForces* forces, Warnings* warnings) {
  return Table(motion, known, forces).Correct(warnings);
}

}  // namespace mmm_converter
