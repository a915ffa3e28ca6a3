// SPDX-License-Identifier: MIT
#include "common/angles/gait.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>

namespace mmm_converter {
namespace {

constexpr double kLongestStride = 2.5;  // [s]
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

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

Eigen::Vector3d HeelAt(const FootMotion& feet, Side side, double time) {
  return ColumnAt(feet.foot(side).heel, (time - feet.first_time) * feet.rate);
}

/// When the foot last touched the ground before a time, within a stride [s]; NaN: not known.
double ContactBefore(const Contacts& contacts, Side side, double time) {
  double last = kNaN;
  for (const FootContact& one : contacts.contacts) {
    if (one.side == side && one.begin && *one.begin < time && time - *one.begin < kLongestStride) {
      last = *one.begin;
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
  const Eigen::Vector3d from = HeelAt(feet, stride.side, stride.begin);
  const Eigen::Vector3d to = HeelAt(feet, stride.side, stride.end);
  const Eigen::Vector3d carried = stride.time() * feet.foot(stride.side).belt;
  const Eigen::Vector2d way = (to - from - carried).head<2>();
  stride.length = way.norm();
  stride.heading = std::atan2(way.y(), way.x());
  const Side other = stride.side == Side::kLeft ? Side::kRight : Side::kLeft;
  const double before = ContactBefore(contacts, other, stride.end);
  stride.step_time = before > stride.begin ? stride.end - before : kNaN;
  stride.step_length = stride.step_width = kNaN;
  if (std::isfinite(stride.step_time) && stride.length > 0) {
    const Eigen::Vector2d forward = way.normalized();
    const Eigen::Vector2d step = (to - HeelAt(feet, other, stride.end)).head<2>();
    stride.step_length = step.dot(forward);
    stride.step_width = std::abs(step.x() * forward.y() - step.y() * forward.x());
  }
  return stride;
}

bool IsKnown(const FootContact& contact, const FootContact& next, const FootMotion& feet,
             const KnownLegs& known) {
  const int begin = feet.frame(*contact.begin), end = feet.frame(*next.begin);
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
      if (IsKnown(*last, one, feet, known)) {
        gait->strides.push_back(StrideOf(*last, one, feet, contacts));
      } else {
        ++gait->left_out;
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

constexpr double kKnownShare = 0.5;  // swing alone, before the next unmeasured stance, is less

bool Counts(const AngleOfStride& stride) {
  int known = 0;
  for (int i = 0; i < GaitCycle::kSamples; ++i) {
    if (std::isfinite(stride.Value(ShareAt(i)))) ++known;
  }
  return known >= kKnownShare * GaitCycle::kSamples;
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

Gait AnalyzeGait(const FootMotion& feet, const Contacts& contacts, const AnatomicalAngles& angles,
                 const KnownLegs& known) {
  Gait gait;
  for (const Side side : kSides) AddStrides(side, feet, contacts, known, &gait);
  gait.cycles = CyclesOf(angles, gait.strides);
  return gait;
}

}  // namespace mmm_converter
