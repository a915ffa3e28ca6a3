// SPDX-License-Identifier: MIT
#include "common/model/subject.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/support/error.h"

namespace mmm_converter {
namespace {

void ScaleSegment(int index, double scale, ModelDescription* model) {
  Segment& segment = model->segments[index];
  segment.X_PF.translation() *= scale;
  segment.p_SB *= scale;
  segment.inertia *= scale * scale;
  if (segment.type == JointType::kPrismatic) {
    segment.lower *= scale;
    segment.upper *= scale;
  }
  for (ModelMarker& marker : model->markers) {
    if (marker.segment == index) marker.p_SM *= scale;
  }
}

}  // namespace

double Observability(double standard_deviation, double prior_deviation) {
  const double share = standard_deviation / prior_deviation;
  return 1 - share * share;
}

double Deviation(const MarkerOffset& offset) {
  return std::sqrt(offset.standard_deviations.squaredNorm() / 3);
}

KinematicModel FitToSubject(const KinematicModel& scaled, const Subject& subject) {
  ModelDescription fitted = DescriptionOf(scaled);
  std::vector<std::string> unknown;
  for (const SegmentScale& scale : subject.scales) {
    const int index = scaled.FindSegment(scale.segment);
    if (index < 0) {
      unknown.push_back(scale.segment);
    } else {
      ScaleSegment(index, scale.scale, &fitted);
    }
  }
  for (const MarkerOffset& offset : subject.offsets) {
    const int index = scaled.FindMarker(offset.marker);
    if (index < 0) {
      unknown.push_back(offset.marker);
    } else {
      fitted.markers[index].p_SM += offset.offset;
      fitted.markers[index].deviation = Deviation(offset);
      if (offset.skin_deviation > 0) fitted.markers[index].skin_deviation = offset.skin_deviation;
    }
  }
  if (!unknown.empty()) {
    throw Error(
        fmt::format("the subject names {}, which the model {} does not have; take the "
                    "model that the subject was calibrated with ({})",
                    fmt::join(unknown, ", "), scaled.name(), subject.model));
  }
  return KinematicModel(std::move(fitted));
}

KinematicModel WithLandmarkBody(const KinematicModel& scaled, const Subject& body) {
  ModelDescription fitted = DescriptionOf(FitToSubject(scaled, body));
  for (std::size_t m = 0; m < fitted.markers.size(); ++m) {
    fitted.markers[m].deviation = scaled.markers()[m].deviation;
  }
  return KinematicModel(std::move(fitted));
}

Subject JoinSubjects(const Subject& body, const Subject& calibrated, const KinematicModel& scaled) {
  Subject joined = calibrated;
  const auto scale_of = [](const Subject& subject, const std::string& segment) {
    for (const SegmentScale& one : subject.scales) {
      if (one.segment == segment) return one.scale;
    }
    return 1.0;
  };
  for (SegmentScale& one : joined.scales) one.scale *= scale_of(body, one.segment);
  for (const SegmentScale& one : body.scales) {
    const bool is_there = std::any_of(joined.scales.begin(), joined.scales.end(),
                                      [&](const auto& own) { return own.segment == one.segment; });
    if (!is_there) joined.scales.push_back(one);
  }
  for (const MarkerOffset& one : body.offsets) {
    const auto own = std::find_if(joined.offsets.begin(), joined.offsets.end(),
                                  [&](const auto& other) { return other.marker == one.marker; });
    const int marker = scaled.FindMarker(one.marker);
    const int segment = scaled.markers()[static_cast<std::size_t>(marker)].segment;
    const double scale =
        scale_of(calibrated, scaled.segments()[static_cast<std::size_t>(segment)].name);
    if (own != joined.offsets.end()) {
      own->offset += scale * one.offset;
    } else {
      joined.offsets.push_back(one);
      joined.offsets.back().offset *= scale;
    }
  }
  return joined;
}

}  // namespace mmm_converter
