// SPDX-License-Identifier: MIT
#include "common/angles/gait.h"

#include <algorithm>
#include <cmath>
#include <limits>
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
  const Eigen::Vector2d way = (to - from).head<2>();
  stride.length = way.norm();
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

std::vector<Stride> StridesOf(Side side, const FootMotion& feet, const Contacts& contacts) {
  std::vector<Stride> strides;
  const FootContact* last = nullptr;
  for (const FootContact& one : contacts.contacts) {
    if (one.side != side || !one.begin) continue;
    if (last != nullptr && *one.begin - *last->begin <= kLongestStride) {
      strides.push_back(StrideOf(*last, one, feet, contacts));
    }
    last = &one;
  }
  return strides;
}

double AngleAt(const AnatomicalAngles& angles, Eigen::Index row, double time) {
  return ColumnAt(angles.values.row(row), (time - angles.first_time) * angles.rate)(0);
}

GaitCycle CycleOf(const AnatomicalAngles& angles, Eigen::Index row, Side side,
                  const std::vector<Stride>& strides) {
  GaitCycle cycle;
  cycle.angle = angles.angles[static_cast<std::size_t>(row)];
  cycle.side = side;
  std::vector<const Stride*> own;
  for (const Stride& one : strides) {
    if (one.side == side) own.push_back(&one);
  }
  cycle.strides = static_cast<int>(own.size());
  const auto count = static_cast<double>(own.size());
  for (int i = 0; i < GaitCycle::kSamples; ++i) {
    const double share = static_cast<double>(i) / (GaitCycle::kSamples - 1);
    double sum = 0, squares = 0;
    for (const Stride* one : own) sum += AngleAt(angles, row, one->begin + share * one->time());
    cycle.mean[i] = sum / count;
    for (const Stride* one : own) {
      const double apart = AngleAt(angles, row, one->begin + share * one->time()) - cycle.mean[i];
      squares += apart * apart;
    }
    cycle.deviation[i] = own.size() > 1 ? std::sqrt(squares / (count - 1)) : kNaN;
  }
  return cycle;
}

}  // namespace

Gait AnalyzeGait(const FootMotion& feet, const Contacts& contacts, const AnatomicalAngles& angles) {
  Gait gait;
  for (const Side side : kSides) {
    const std::vector<Stride> strides = StridesOf(side, feet, contacts);
    gait.strides.insert(gait.strides.end(), strides.begin(), strides.end());
  }
  for (const Side side : kSides) {
    const bool has_stride = std::any_of(gait.strides.begin(), gait.strides.end(),
                                        [&](const Stride& one) { return one.side == side; });
    for (std::size_t i = 0; has_stride && i < angles.angles.size(); ++i) {
      const std::string_view of = angles.angles[i].side;
      if (!of.empty() && of != Name(side)) continue;
      gait.cycles.push_back(CycleOf(angles, static_cast<Eigen::Index>(i), side, gait.strides));
    }
  }
  return gait;
}

}  // namespace mmm_converter
