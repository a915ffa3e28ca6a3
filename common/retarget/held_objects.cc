// SPDX-License-Identifier: MIT
#include "common/retarget/held_objects.h"

#include <algorithm>
#include <cmath>

namespace mmm_converter {
namespace {

using Eigen::Vector3d;

constexpr double kPalm = 0.37;          // of the forearm: the hand's centre of mass (Winter 1990)
constexpr double kNear = 0.08;          // [m] of the palm from where the object's markers are
constexpr double kNoMore = 0.14;        // [m]
constexpr double kSize = 0.25;          // [m] within which an object without markers is
constexpr double kStill = 0.12;         // [m/s] in the object
constexpr double kLeaves = 0.3;         // [m/s]
constexpr double kOver = 0.04;          // [s] before and behind, of a speed
constexpr double kShortestHold = 0.25;  // [s] of a hold
constexpr double kMovedAlong = 0.02;    // [m] of an object that is taken along
constexpr double kTurnedAlong = 0.15;   // [rad]
constexpr double kEase = 0.2;           // [s] before and behind a hold

double DistanceOf(const TrackedObject& object, const Vector3d& palm_O) {
  if (object.extent.isEmpty()) return std::max(0.0, palm_O.norm() - kSize);
  return object.extent.exteriorDistance(palm_O);
}

bool IsMoved(const TrackedObject& object, int begin, int end) {
  const Eigen::Isometry3d& first = object.X_WO[begin];
  for (int k = begin; k < end; ++k) {
    const Eigen::Isometry3d X = first.inverse() * object.X_WO[k];
    if (X.translation().norm() > kMovedAlong) return true;
    if (Eigen::AngleAxisd(X.linear()).angle() > kTurnedAlong) return true;
  }
  return false;
}

/// Of one hand and one object.
void AddHolds(const HumanMotion& human, const TrackedObject& object, Hold hold,
              std::vector<Hold>* holds) {
  std::vector<Vector3d> palms;  // from object.begin on
  for (int k = object.begin; k < object.end; ++k) {
    palms.push_back(object.X_WO[k].inverse() * PalmOf(human.bodies[k].arms[hold.hand]));
  }
  const int count = static_cast<int>(palms.size());
  const int reach = std::max(1, static_cast<int>(std::lround(kOver * human.rate)));
  const auto end_hold = [&](int begin, int end) {
    hold.begin = object.begin + begin;
    hold.end = object.begin + end;
    const bool is_long = end - begin >= kShortestHold * human.rate;
    if (is_long && IsMoved(object, hold.begin, hold.end)) holds->push_back(hold);
  };
  int begin = -1;
  for (int i = 0; i < count; ++i) {
    const int before = std::max(0, i - reach), behind = std::min(count - 1, i + reach);
    const double speed =
        behind == before ? 0
                         : (palms[behind] - palms[before]).norm() * human.rate / (behind - before);
    const double distance = DistanceOf(object, palms[i]);
    if (begin < 0 && distance < kNear && speed < kStill) begin = i;
    if (begin < 0 || (distance <= kNoMore && speed <= kLeaves)) continue;
    end_hold(begin, i);
    begin = -1;
  }
  if (begin >= 0) end_hold(begin, count);
}

}  // namespace

Vector3d PalmOf(const LimbPosture& arm) {
  return arm.distal - kPalm * (arm.distal - arm.middle).norm() * arm.R_end.col(2);
}

std::vector<Hold> FindHolds(const HumanMotion& human, const std::vector<TrackedObject>& objects) {
  std::vector<Hold> holds;
  for (std::size_t object = 0; object < objects.size(); ++object) {
    for (const std::size_t hand : {0, 1}) {
      AddHolds(human, objects[object], {static_cast<int>(object), hand}, &holds);
    }
  }
  return holds;
}

std::vector<double> WeightsOfHold(const std::vector<Hold>& holds, std::size_t hand, double rate,
                                  int frames) {
  std::vector<double> weights(frames, 0.0);
  const int ease = static_cast<int>(std::ceil(kEase * rate));
  for (const Hold& hold : holds) {
    if (hold.hand != hand) continue;
    for (int k = std::max(0, hold.begin - ease); k < std::min(frames, hold.end + ease); ++k) {
      const int off = std::max({0, hold.begin - k, k - hold.end + 1});
      const double part = 1 - off / (ease + 1.0);
      weights[k] = std::max(weights[k], part * part * (3 - 2 * part));
    }
  }
  return weights;
}

TrackedObject ScaledObject(TrackedObject object, double scale, double floor) {
  for (Eigen::Isometry3d& X : object.X_WO) {
    X.translation() = scale * (X.translation() - floor * Vector3d::UnitZ());
  }
  if (!object.extent.isEmpty()) {
    object.extent = {scale * object.extent.min(), scale * object.extent.max()};
  }
  return object;
}

}  // namespace mmm_converter
