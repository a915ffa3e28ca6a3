// SPDX-License-Identifier: MIT
#include "common/angles/gait.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>

#include "common/angles/gait_feet.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

constexpr double kUsualStride = 2.5;  // [s]
constexpr double kMostStance = 0.85;  // of a slow stride: who lifts no foot longer stands
constexpr double kStanceBegin = 0.3, kStanceEnd = 0.7;  // of a contact: the foot is flat
// Of the speed, between those that both feet show, below which they are on one belt.
constexpr double kOneBelt = 0.15;
constexpr double kUncutStance = 0.4;     // [s] of a contact whose end is not known
constexpr double kTurn = 20 / kDegrees;  // [rad] by which a foot's way differs at random
constexpr double kRuns = 0.5;            // of a stride on the ground: who stands less has a flight
constexpr double kStair = 0.08;          // [m] of a stride; kerbs and stairs are higher
constexpr double kStairs = 0.36;         // rise by length: stairs begin at 20 degrees (DIN 18065)

/// A column at a time between two frames: on a straight line; beyond the ends the last.
template <typename Columns>
auto ColumnAt(const Columns& columns, double frame) {
  const Eigen::Index last = columns.cols() - 1;
  const double at = std::clamp(frame, 0.0, static_cast<double>(last));
  const auto before = static_cast<Eigen::Index>(at);
  const double share = at - static_cast<double>(before);
  return ((1 - share) * columns.col(before) + share * columns.col(std::min(before + 1, last)))
      .eval();
}

/// Where a foot stands in mid-stance, and when; W, also on a belt.
struct StandingPlace {
  double time = 0;
  Eigen::Vector3d toe = Eigen::Vector3d::Zero(), heel = Eigen::Vector3d::Zero();
  double yaw = 0;  ///< of the foot, from W's x to its y [rad]
};

StandingPlace PlaceOf(const FootContact& contact, const FootMotion& feet) {
  const FootPath& foot = feet.foot(contact.side);
  const double last = feet.time(feet.num_frames() - 1);
  const double end = contact.end.value_or(std::min(*contact.begin + kUncutStance, last));
  const double span = std::max(0.0, end - *contact.begin);
  const double from = *contact.begin + kStanceBegin * span;
  const double to = *contact.begin + kStanceEnd * span;
  const auto frame = [&](double time) { return (time - feet.first_time) * feet.rate; };
  StandingPlace place;
  place.time = (from + to) / 2;
  constexpr int kSamples = 5;
  for (int i = 0; i < kSamples; ++i) {
    const double at = frame(from + (to - from) * i / (kSamples - 1));
    place.toe += ColumnAt(foot.toe, at) / kSamples;
    place.heel += ColumnAt(foot.heel, at) / kSamples;
  }
  const Eigen::Vector3d line = place.toe - place.heel;
  place.yaw = std::atan2(line.y(), line.x());
  return place;
}

/// With belts as feet show them in mid-stance: both together, where they tell one speed.
FootMotion WithBelts(FootMotion feet, const Contacts& contacts) {
  if (feet.foot(Side::kLeft).belt.isZero(0)) return feet;
  std::array<Eigen::Vector3d, 2> ways = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  std::array<double, 2> times = {0, 0};
  for (const FootContact& contact : contacts.contacts) {
    if (!contact.begin || !contact.end) continue;
    const FootPath& foot = feet.foot(contact.side);
    const double span = *contact.end - *contact.begin;
    const auto middle = [&](double share) -> Eigen::Vector3d {
      const double at = (*contact.begin + share * span - feet.first_time) * feet.rate;
      return (ColumnAt(foot.heel, at) + ColumnAt(foot.toe, at)) / 2;
    };
    const auto side = static_cast<std::size_t>(contact.side);
    ways[side] += middle(kStanceEnd) - middle(kStanceBegin);
    times[side] += (kStanceEnd - kStanceBegin) * span;
  }
  if (times[0] == 0 || times[1] == 0) return feet;
  for (Eigen::Vector3d& way : ways) way.z() = 0;
  const Eigen::Vector3d left = ways[0] / times[0], right = ways[1] / times[1];
  const Eigen::Vector3d both = (ways[0] + ways[1]) / (times[0] + times[1]);
  const bool is_one = (left - right).norm() < kOneBelt * both.norm();
  feet.feet[0].belt = is_one ? both : left;
  feet.feet[1].belt = is_one ? both : right;
  return feet;
}

/// From an end of a foot at one place to that of a foot at a later one, on the belt where there is
/// one.
Eigen::Vector3d WayBetween(Eigen::Vector3d StandingPlace::*end, const StandingPlace& from,
                           const StandingPlace& to, const Eigen::Vector3d& belt) {
  return to.*end - from.*end - (to.time - from.time) * belt;
}

/// The foot's last contact that began before a time, within a stride; null: not known.
const FootContact* ContactBefore(const Contacts& contacts, Side side, double time) {
  const FootContact* last = nullptr;
  for (const FootContact& one : contacts.contacts) {
    if (one.side == side && one.begin && *one.begin < time && time - *one.begin < kLongestStride) {
      last = &one;
    }
  }
  return last;
}

Stride StrideOf(const FootContact& contact, const FootContact& next, const FootMotion& feet,
                const Contacts& contacts) {
  Stride stride;
  stride.side = contact.side;
  stride.begin = *contact.begin;
  stride.end = *next.begin;
  stride.time_deviation = std::hypot(contact.begin_deviation, next.begin_deviation);
  stride.foot_off = contact.end ? (*contact.end - stride.begin) / stride.time() : kNaN;
  const StandingPlace from = PlaceOf(contact, feet);
  const StandingPlace to = PlaceOf(next, feet);
  const Eigen::Vector3d& belt = feet.foot(stride.side).belt;
  const Eigen::Vector3d of_foot = WayBetween(&StandingPlace::toe, from, to, belt);
  const Eigen::Vector2d way = of_foot.head<2>();
  stride.rise = of_foot.z();
  stride.length = way.norm();
  stride.heading = std::atan2(way.y(), way.x());
  stride.is_backwards = std::cos(from.yaw - stride.heading) < 0;
  stride.double_support = DoubleSupport(stride, contacts);
  const Side other = stride.side == Side::kLeft ? Side::kRight : Side::kLeft;
  const FootContact* before = ContactBefore(contacts, other, stride.end);
  const bool is_step = before != nullptr && *before->begin > stride.begin;
  const double of_own = std::hypot(contact.begin_deviation, contact.end_deviation);
  const double of_other =
      before == nullptr ? of_own : std::hypot(before->begin_deviation, before->end_deviation);
  stride.foot_off_deviation = of_own / stride.time();
  stride.double_support_deviation = std::hypot(of_own, of_other) / stride.time();
  stride.step_time = is_step ? stride.end - *before->begin : kNaN;
  stride.step_length = stride.step_width = kNaN;
  if (is_step && stride.length > 0) {
    const Eigen::Vector2d forward = way.normalized();
    const StandingPlace behind = PlaceOf(*before, feet);
    const Eigen::Vector3d of_belts = (belt + feet.foot(other).belt) / 2;
    const Eigen::Vector2d rightward(forward.y(), -forward.x());
    stride.step_length =
        WayBetween(&StandingPlace::toe, behind, to, of_belts).head<2>().dot(forward);
    // Toes point outwards.
    const double to_right =
        WayBetween(&StandingPlace::heel, behind, to, of_belts).head<2>().dot(rightward);
    stride.step_width = (stride.side == Side::kRight) != stride.is_backwards ? to_right : -to_right;
  }
  return stride;
}

/// Whether the person walks on in it, rather than stands.
bool Walks(const Stride& stride) {
  if (stride.time() <= kUsualStride) return true;
  return stride.foot_off > 0 && stride.foot_off < kMostStance && std::isfinite(stride.step_time);
}

bool IsTurn(const FootContact& contact, const FootContact& next, const FootMotion& feet) {
  const double turned = PlaceOf(next, feet).yaw - PlaceOf(contact, feet).yaw;
  return std::abs(std::remainder(turned, 2 * std::numbers::pi)) > kTurn;
}

GaitKind KindOf(const std::vector<Stride>& strides) {
  const auto are_most = [&](auto is_so) {
    return 2 * std::count_if(strides.begin(), strides.end(), is_so) >
           static_cast<std::ptrdiff_t>(strides.size());
  };
  if (are_most([](const Stride& one) { return std::abs(one.rise) > kStair; })) {
    const bool are_steep =
        are_most([](const Stride& one) { return std::abs(one.rise) > kStairs * one.length; });
    return are_steep ? GaitKind::kStairs : GaitKind::kRamp;
  }
  if (are_most([](const Stride& one) { return one.foot_off < kRuns; })) return GaitKind::kRunning;
  const bool goes_back = are_most([](const Stride& one) { return one.is_backwards; });
  return goes_back ? GaitKind::kBackwards : GaitKind::kWalking;
}

bool IsKnown(const FootContact& contact, const FootContact& next, const FootMotion& feet,
             const KnownLegs& known) {
  const int begin = feet.frame(*contact.begin - kSeenBeside), end = feet.frame(*next.begin);
  return std::all_of(known.begin(), known.end(), [&](const std::vector<bool>& leg) {
    return std::find(leg.begin() + begin, leg.begin() + end + 1, false) == leg.begin() + end + 1;
  });
}

void AddStrides(Side side, const FootMotion& feet, const Contacts& contacts, const KnownLegs& known,
                Gait* gait) {
  const FootContact* last = nullptr;
  for (const FootContact& one : contacts.contacts) {
    if (one.side != side || !one.begin) continue;
    if (last != nullptr && *one.begin - *last->begin <= kLongestStride) {
      if (!IsKnown(*last, one, feet, known)) {
        ++gait->left_out;
      } else if (const Stride stride = StrideOf(*last, one, feet, contacts); Walks(stride)) {
        if (IsTurn(*last, one, feet)) {
          ++gait->turns;
        } else {
          gait->strides.push_back(stride);
        }
      }
    }
    last = &one;
  }
}

double ShareAt(int sample) { return static_cast<double>(sample) / (GaitCycle::kSamples - 1); }

/// An angle over a stride.
class AngleOfStride {
 public:
  AngleOfStride(const AnatomicalAngles& angles, Eigen::Index row, const Stride& stride)
      : angles_(angles), row_(row), stride_(stride) {
    const AnatomicalAngle& angle = angles.angles[static_cast<std::size_t>(row)];
    const bool is_heading =
        std::string_view(angle.joint) == "pelvis" && std::string_view(angle.motion) == "rotation";
    if (!is_heading) return;
    const double along = stride.heading - std::atan2(angles.forward.y(), angles.forward.x());
    const double apart = ColumnAt(angles.values.row(row), FrameAt(0))(0) - along;
    zero_ = along + apart - std::remainder(apart, 2 * std::numbers::pi);
  }

  double Value(double share) const {
    return ColumnAt(angles_.values.row(row_), FrameAt(share))(0) - zero_;
  }
  double Deviation(double share) const {
    if (angles_.deviations.size() == 0) return kNaN;
    return ColumnAt(angles_.deviations.row(row_), FrameAt(share))(0);
  }

 private:
  double FrameAt(double share) const {
    return (stride_.begin + share * stride_.time() - angles_.first_time) * angles_.rate;
  }

  const AnatomicalAngles& angles_;
  Eigen::Index row_;
  const Stride& stride_;
  double zero_ = 0;
};

// Forces are known while a foot is on a plate: its stance counts, without the swing too, but not
// the swing alone, before the next unmeasured stance.
constexpr double kKnownShare = 0.5, kKnownOfFirstHalf = 0.8;

bool Counts(const AngleOfStride& stride) {
  int known = 0, early = 0;
  for (int i = 0; i < GaitCycle::kSamples; ++i) {
    if (!std::isfinite(stride.Value(ShareAt(i)))) continue;
    ++known;
    if (2 * i < GaitCycle::kSamples) ++early;
  }
  return known >= kKnownShare * GaitCycle::kSamples ||
         2 * early >= kKnownOfFirstHalf * GaitCycle::kSamples;
}

GaitCycle CycleOf(const AnatomicalAngles& angles, Eigen::Index row, Side side,
                  const std::vector<Stride>& strides) {
  GaitCycle cycle;
  cycle.angle = angles.angles[static_cast<std::size_t>(row)];
  cycle.side = side;
  std::vector<AngleOfStride> own;
  for (const Stride& one : strides) {
    if (one.side != side) continue;
    const AngleOfStride angle(angles, row, one);
    if (Counts(angle)) own.push_back(angle);
  }
  cycle.strides = static_cast<int>(own.size());
  for (int i = 0; i < GaitCycle::kSamples; ++i) {
    const double share = ShareAt(i);
    double sum = 0, squares = 0, uncertain = 0, count = 0;
    for (const AngleOfStride& one : own) {
      if (!std::isfinite(one.Value(share))) continue;
      sum += one.Value(share);
      uncertain += one.Deviation(share) * one.Deviation(share);
      ++count;
    }
    const double mean = sum / count;
    for (const AngleOfStride& one : own) {
      if (!std::isfinite(one.Value(share))) continue;
      squares += (one.Value(share) - mean) * (one.Value(share) - mean);
    }
    cycle.mean[i] = mean;
    cycle.deviation[i] = count > 1 ? std::sqrt(squares / (count - 1)) : kNaN;
    cycle.uncertainty[i] = std::sqrt(uncertain / count);
  }
  return cycle;
}

}  // namespace

const char* Name(GaitKind kind) {
  constexpr const char* kNames[] = {"walking", "running", "walking backwards", "stairs", "a ramp"};
  return kNames[static_cast<int>(kind)];
}

std::vector<GaitCycle> CyclesOf(const AnatomicalAngles& rows, const std::vector<Stride>& strides) {
  std::vector<GaitCycle> cycles;
  for (const Side side : kSides) {
    for (std::size_t i = 0; i < rows.angles.size(); ++i) {
      const std::string_view of = rows.angles[i].side;
      if (!of.empty() && of != Name(side)) continue;
      GaitCycle cycle = CycleOf(rows, static_cast<Eigen::Index>(i), side, strides);
      if (cycle.strides > 0) cycles.push_back(cycle);
    }
  }
  return cycles;
}

Gait AnalyzeGait(const FootMotion& moved, const Contacts& contacts, const AnatomicalAngles& angles,
                 const KnownLegs& known) {
  const FootMotion feet = WithBelts(moved, contacts);
  Gait gait;
  for (const Side side : kSides) AddStrides(side, feet, contacts, known, &gait);
  gait.kind = KindOf(gait.strides);
  if (gait.kind == GaitKind::kRunning) {
    for (Stride& one : gait.strides) one.double_support = kNaN;
  }
  gait.cycles = CyclesOf(angles, gait.strides);
  return gait;
}

}  // namespace mmm_converter
