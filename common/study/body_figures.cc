// SPDX-License-Identifier: MIT
#include "common/study/body_figures.h"

#include <algorithm>
#include <cmath>

#include "common/fit/rigid_shape.h"
#include "common/math/statistics.h"
#include "common/model/coordinate_map.h"
#include "common/motion/marker_noise.h"

namespace mmm_converter {
namespace {

/// How far the markers are from where they were a frame before [m]: of half of them, further.
double StepTo(int k, const TrackingSetup& setup, const MarkerSequence& markers) {
  std::vector<double> steps;
  for (const MarkerAssignment& one : setup.assignments()) {
    const double step =
        (markers.frame(k).col(one.label) - markers.frame(k - 1).col(one.label)).norm();
    if (!std::isnan(step)) steps.push_back(step);
  }
  return static_cast<int>(steps.size()) < kFewestMarkers ? kNaN : Median(steps);
}

std::vector<double> MeasureJumps(const TrackingSetup& setup, const MarkerSequence& markers) {
  std::vector<double> jumps(static_cast<std::size_t>(markers.num_frames()), kNaN);
  double before = kNaN, step = kNaN;
  for (int k = 1; k < markers.num_frames(); ++k) {
    const double after = StepTo(k, setup, markers);
    const bool is_known = !std::isnan(before) && !std::isnan(after);
    if (is_known) jumps[static_cast<std::size_t>(k - 1)] = step - std::max(before, after);
    before = step;
    step = after;
  }
  return jumps;
}

TrunkFigures MeasureTrunk(const KinematicModel& model, const std::vector<Posture>& postures) {
  constexpr double kUprightRoot = 0.5;  // cosine of 60 degrees
  if (model.is_root_fixed()) return {};
  // Of the root that is upright.
  Eigen::Vector3d up_S = Eigen::Vector3d::UnitZ();
  if (model.coordinates()) up_S = RestPosture(model).orientation.inverse() * up_S;
  double lying = 0;
  double upside_down = 0;
  for (const Posture& posture : postures) {
    const double up = (posture.orientation.toRotationMatrix() * up_S).z();
    lying += up < kUprightRoot ? 1 : 0;
    upside_down += up < -kUprightRoot ? 1 : 0;
  }
  const auto frames = static_cast<double>(postures.size());
  return {lying / frames, upside_down / frames};
}

}  // namespace

BodyFigures MeasureBody(const TrackingSetup& setup, const MarkerSequence& markers,
                        const ConversionResult& result) {
  BodyFigures figures;
  figures.gaps = LongGaps(setup, markers);
  figures.coverage = MeasureCoverage(setup);
  figures.limb_places = MeasureLimbPlaces(setup, figures.coverage.limbs, markers, result.trajectory,
                                          result.residuals);
  figures.jumps = MeasureJumps(setup, markers);
  figures.noise = MeasureMarkerNoise(markers, LabelIndices(setup.assignments()));
  figures.trunk = MeasureTrunk(*setup.model, result.trajectory.postures);
  figures.limits = MeasureBodyLimits(setup, markers, result.trajectory);
  figures.slipped = FindSlippedPelvis(setup, markers);
  return figures;
}

BodyFigures MeasureObject(const TrackingSetup& setup, const MarkerSequence& markers) {
  BodyFigures figures;
  figures.gaps = LongGaps(setup, markers);
  Eigen::Matrix3Xd places(3, static_cast<Eigen::Index>(setup.assignments().size()));
  for (Eigen::Index i = 0; i < places.cols(); ++i) {
    const int marker = setup.assignments()[static_cast<std::size_t>(i)].marker;
    places.col(i) = setup.model->markers()[marker].p_SM;
  }
  figures.radius = RadiusOf(places);
  return figures;
}

}  // namespace mmm_converter
