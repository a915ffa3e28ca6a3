// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <set>
#include <span>

#include "common/fit/height_estimate.h"
#include "common/fit/posture_search.h"
#include "common/judge/evidence.h"
#include "common/math/statistics.h"
#include "common/pipeline/recording_labels.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

using Eigen::Matrix3Xd;

constexpr int kFrames = 24, kFewestPoints = 10, kAttempts = 4;

/// The markers that points have the names of, and columns of these points.
struct NamedMarkersOf {
  std::vector<MarkerIx> markers;
  std::vector<LabelIx> columns;
  std::vector<std::string> names;
  Eigen::VectorXd noise_scale;
};

NamedMarkersOf FindMarkers(const FoundLabels& found, const MarkerSequence& named) {
  NamedMarkersOf of;
  std::vector<double> scales;
  for (const MarkerAssignment& one : found.setup.assignments()) {
    const std::string name = found.labelling.names[one.label].substr(found.prefix.size());
    const int column = named.FindLabel(name);
    if (column < 0) continue;
    of.markers.push_back(one.marker);
    of.columns.emplace_back(column);
    of.names.push_back(name);
    scales.push_back(one.noise_scale);
  }
  of.noise_scale = Eigen::Map<Eigen::VectorXd>(scales.data(), std::ssize(scales));
  return of;
}

/// Frames x markers [m]; NaN: not seen, or the frame shows too few. fit: gets the frames that show
/// enough; may be null.
Eigen::MatrixXd Distances(const FoundLabels& found, const NamedMarkersOf& of,
                          const MarkerSequence& named, FittedLabels* fit) {
  const MarkerKinematics kinematics(*found.setup.model, found.setup.joints, of.markers);
  MarkerJacobian at = kinematics.MakeJacobian();
  PostureSearch search(kinematics);
  PostureFitOptions options;
  options.robust_distance = 0.1;
  Eigen::MatrixXd distances = Eigen::MatrixXd::Constant(kFrames, kinematics.num_markers(), kNaN);
  std::vector<int> told;
  std::vector<Posture> postures;
  for (int i = 0; i < kFrames; ++i) {
    const int k = (2 * i + 1) * named.num_frames() / (2 * kFrames);
    const Matrix3Xd z = named.frame(k)(Eigen::all, of.columns);
    if (z.row(0).array().isFinite().count() < kFewestPoints) continue;
    Posture posture;
    search.Assemble(z, of.noise_scale, options, kAttempts, &posture);
    kinematics.ComputeMarkers(posture.position, posture.orientation.toRotationMatrix(),
                              posture.joint_angles, &at);
    distances.row(i) = (z - at.p_WM).colwise().norm();
    told.push_back(k);
    postures.push_back(std::move(posture));
  }
  if (fit != nullptr) {
    const int n = static_cast<int>(told.size());
    fit->frames = MarkerSequence(named.labels(), n, named.rate(), 0);
    for (int i = 0; i < n; ++i) fit->frames.frame(i) = named.frame(told[i]);
    fit->trajectory.postures = std::move(postures);
    fit->trajectory.rate = named.rate();
  }
  return distances;
}

/// Of a marker; NaN: never seen.
double MeanDistance(const Eigen::MatrixXd& distances, Eigen::Index marker) {
  return Mean({distances.col(marker).data(), static_cast<std::size_t>(distances.rows())});
}

}  // namespace

std::vector<RelabelledPoint> PointsOfPerson(const FoundLabels& found) {
  std::set<std::string> others;
  for (const OtherBody& other : found.others) {
    for (int i = other.first_name; i < other.end_name; ++i) others.insert(found.labelling.names[i]);
  }
  std::vector<RelabelledPoint> points;
  for (const RelabelledPoint& point : found.points) {
    if (point.label.starts_with('*')) continue;
    if (point.is_named && others.contains(point.label)) continue;
    points.push_back(point);
    if (point.is_named) points.back().label.erase(0, found.prefix.size());
  }
  return points;
}

std::set<std::string> NamesThatFit(const FoundLabels& found, const MarkerSequence& markers,
                                   double most) {
  const NamedMarkersOf of = FindMarkers(found, markers);
  std::set<std::string> names;
  if (of.markers.size() < kFewestPoints) return names;
  const Eigen::MatrixXd distances = Distances(found, of, markers, nullptr);
  for (Eigen::Index m = 0; m < distances.cols(); ++m) {
    if (MeanDistance(distances, m) <= most) names.insert(of.names[static_cast<std::size_t>(m)]);
  }
  return names;
}

NamingFigures MeasureNaming(const Labelling& labelling, const MarkerSequence& markers) {
  NamingFigures figures;
  std::vector<int> unnamed(static_cast<std::size_t>(markers.num_labels()), 0);  // frames, by point
  double unsure = 0, named = 0;
  for (const NamedPiece& piece : labelling.pieces) {
    const int length = piece.end - piece.begin;
    if (piece.name < 0) {
      unnamed[piece.point] += length;
    } else {
      named += length;
      unsure += (1 - piece.probability) * length;
    }
  }
  figures.num_names = static_cast<int>(labelling.names.size());
  figures.missing = NamesNotFound(labelling);
  figures.spare_points = static_cast<int>(std::count_if(
      unnamed.begin(), unnamed.end(), [&](int n) { return 2 * n > markers.num_frames(); }));
  if (named > 0) figures.unsure = unsure / named;
  return figures;
}

FittedLabels FitLabels(const FoundLabels& found, const MarkerSequence& markers,
                       const KinematicModel* reference) {
  FittedLabels fitted;
  LabelFit& fit = fitted.figures;
  const MarkerSequence named = Relabelled(PointsOfPerson(found), markers);
  const NamedMarkersOf of = FindMarkers(found, named);
  if (of.markers.size() < kFewestPoints) return fitted;
  const Eigen::MatrixXd distances = Distances(found, of, named, &fitted);
  if (!distances.array().isFinite().any()) return fitted;
  fitted.setup = found.setup;
  fitted.setup.mapping.assignments.clear();
  for (std::size_t m = 0; m < of.markers.size(); ++m) {
    const double scale = of.noise_scale[static_cast<Eigen::Index>(m)];
    fitted.setup.mapping.assignments.push_back({of.columns[m], of.markers[m], scale});
  }
  for (Eigen::Index m = 0; m < distances.cols(); ++m) {
    const double mean = MeanDistance(distances, m);
    if (!std::isfinite(mean)) continue;
    fit.farthest = std::max(fit.farthest, mean);
    if (kMarkerMean.IsBeyond(mean)) fit.far_names.push_back(of.names[static_cast<std::size_t>(m)]);
  }
  const std::span<const double> all(distances.data(), static_cast<std::size_t>(distances.size()));
  fit.mean_distance = Mean(all);
  fit.p95_distance = Percentile(all, 95);
  if (reference == nullptr) return fitted;
  // Of a repair by the names that were there: those that were found are sought at the height.
  const bool are_old_right = found.is_repair && !found.has_exchanged_sides;
  const MarkerSequence& telling = are_old_right ? markers : named;
  const NamedMarkersOf told = FindMarkers(found, telling);
  if (told.markers.size() < kFewestPoints) return fitted;
  HeightOptions options;
  options.noise_scale = told.noise_scale;
  fit.told_height =
      EstimateHeight(*reference, found.setup.joints, told.markers, told.columns, telling, options)
          .height;
  return fitted;
}

}  // namespace mmm_converter
