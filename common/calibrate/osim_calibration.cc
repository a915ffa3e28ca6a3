// SPDX-License-Identifier: MIT
#include "common/calibrate/osim_calibration.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "common/calibrate/body_kinematics.h"
#include "common/calibrate/calibration_frames.h"
#include "common/calibrate/osim_sizes.h"
#include "common/fit/posture_search.h"
#include "common/io/osim/osim_model_reader.h"
#include "common/io/osim/osim_scaling.h"
#include "common/math/statistics.h"
#include "common/model/coordinate_map.h"

namespace mmm_converter {

using Eigen::VectorXd;

namespace {

constexpr double kLeastSize = 0.4, kMostSize = 1.6, kSizeStep = 0.05;
constexpr int kSizeFrames = 12;
constexpr int kSizeAttempts = 2;
constexpr double kSizeRobustDistance = 0.1;  // [m]

class OsimCalibration {
 public:
  OsimCalibration(const OsimDocument& document, std::string file, const KinematicModel& reference,
                  const std::vector<int>& joints,
                  const std::vector<CalibrationRecording>& recordings)
      : document_(document),
        file_(std::move(file)),
        reference_(reference),
        joints_(joints),
        markers_(UsedMarkers(recordings)),
        sizes_(FindOsimSizes(document, BodiesWithMarkers())) {}

  const std::vector<MarkerIx>& markers() const { return markers_; }
  /// The size of the whole model that fits best in some frames.
  double FindSize(const std::vector<CalibrationRecording>& recordings,
                  const CalibrationOptions& options) const;
  std::vector<double> Factors(double size, const VectorXd& scales) const;
  KinematicModel Scaled(double size, const VectorXd& scales) const;
  BodySizes Sizes(double size) const;
  VectorXd Ones() const { return VectorXd::Ones(static_cast<Eigen::Index>(sizes_.bodies.size())); }

 private:
  std::vector<bool> BodiesWithMarkers() const;
  const OsimMarker* SourceOf(MarkerIx marker) const;

  const OsimDocument& document_;
  std::string file_;
  const KinematicModel& reference_;
  const std::vector<int>& joints_;
  std::vector<MarkerIx> markers_;
  OsimSizes sizes_;
};

const OsimMarker* OsimCalibration::SourceOf(MarkerIx marker) const {
  const std::string& name = reference_.markers()[marker].name;
  const auto found = std::find_if(document_.markers.begin(), document_.markers.end(),
                                  [&](const OsimMarker& one) { return one.name == name; });
  return found == document_.markers.end() ? nullptr : &*found;
}

std::vector<bool> OsimCalibration::BodiesWithMarkers() const {
  std::vector<bool> has_marker(document_.bodies.size(), false);
  for (const MarkerIx marker : markers_) {
    if (const OsimMarker* source = SourceOf(marker)) has_marker[source->body] = true;
  }
  return has_marker;
}

std::vector<double> OsimCalibration::Factors(double size, const VectorXd& scales) const {
  std::vector<double> factors(document_.bodies.size(), size);
  for (std::size_t body = 0; body < factors.size(); ++body) {
    if (sizes_.size_of[body] >= 0) factors[body] = size * scales[sizes_.size_of[body]];
  }
  factors[0] = 1;  // ground
  return factors;
}

KinematicModel OsimCalibration::Scaled(double size, const VectorXd& scales) const {
  Diagnostics diagnostics(file_);
  return MakeOsimModel(ScaleOsimDocument(document_, Factors(size, scales)), &diagnostics);
}

BodySizes OsimCalibration::Sizes(double size) const {
  BodySizes sizes;
  for (const int body : sizes_.bodies) {
    for (const MarkerIx marker : markers_) {
      const OsimMarker* source = SourceOf(marker);
      if (source == nullptr || source->body != body) continue;
      sizes.lengths.segments.push_back(reference_.markers()[marker].segment);
      break;
    }
  }
  sizes.lengths.mirror = sizes_.mirror;
  sizes.rescale = [this, size](const VectorXd& scales) { return Scaled(size, scales); };
  return sizes;
}

double OsimCalibration::FindSize(const std::vector<CalibrationRecording>& recordings,
                                 const CalibrationOptions& options) const {
  const int least_seen = std::max(3, static_cast<int>(markers_.size()) / 2);
  const std::vector<CalibrationFrame> all = CandidateFrames(recordings, markers_, least_seen);
  std::vector<CalibrationFrame> some;
  for (int i = 0; i < kSizeFrames && !all.empty(); ++i) {
    some.push_back(all[i * all.size() / kSizeFrames]);
  }
  PostureFitOptions fit_options;
  fit_options.robust_distance = kSizeRobustDistance;
  const VectorXd noise = VectorXd::Ones(static_cast<Eigen::Index>(markers_.size()));
  double best = 1, least = std::numeric_limits<double>::infinity();
  const auto steps = std::lround((kMostSize - kLeastSize) / kSizeStep);
  for (long step = 0; step <= steps; ++step) {
    const double size = kLeastSize + static_cast<double>(step) * kSizeStep;
    const KinematicModel model = Scaled(size, Ones());
    const MarkerKinematics kinematics(model, joints_, markers_);
    PostureSearch search(kinematics);
    std::vector<double> distances;
    for (const CalibrationFrame& frame : some) {
      if (options.between_steps) options.between_steps();
      Posture posture;
      distances.push_back(
          search.Assemble(frame.z, noise, fit_options, kSizeAttempts, &posture).mean_distance);
    }
    if (distances.empty() || Median(distances) >= least) continue;
    least = Median(distances);
    best = size;
  }
  return best;
}

}  // namespace

CalibrationOptions OsimCalibrationOptions() {
  CalibrationOptions options;
  options.marker_deviation = 0.02;
  options.height_deviation = 0.1;
  options.may_stand = true;
  return options;
}

CalibratedOsim CalibrateOsim(const NamedText& model, const OsimDocument& document,
                             const KinematicModel& reference, const std::vector<int>& joints,
                             const std::vector<CalibrationRecording>& recordings,
                             std::optional<double> mass, const CalibrationOptions& options,
                             Warnings* warnings) {
  CalibratedOsim calibrated;
  const OsimCalibration calibration(document, model.file, reference, joints, recordings);
  calibrated.size = calibration.FindSize(recordings, options);
  const KinematicModel start = calibration.Scaled(calibrated.size, calibration.Ones());
  BodyKinematics kinematics(start, joints, calibration.markers(),
                            calibration.Sizes(calibrated.size));
  calibrated.result = CalibrateBody(&kinematics, recordings, options, warnings);

  const std::vector<SegmentScale>& scales = calibrated.result.subject.scales;
  VectorXd found = calibration.Ones();
  for (std::size_t i = 0; i < scales.size(); ++i) {
    found[static_cast<Eigen::Index>(i)] = scales[i].scale;
  }
  const std::vector<double> factors = calibration.Factors(calibrated.size, found);
  ScaledOsim& scaled = calibrated.scaled;
  OsimScaling scaling;
  scaling.mass = mass;
  for (std::size_t body = 1; body < factors.size(); ++body) {
    scaling.factors[document.bodies[body].name] = Eigen::Vector3d::Constant(factors[body]);
  }
  scaled.content = WriteOsimMarkers(model.content, model.file, document, document.markers);
  scaled.content = ScaleOsim(scaled.content, model.file, scaling, warnings);
  scaled.factors = std::move(scaling.factors);
  OsimDocument person = ScaleOsimDocument(document, factors);
  for (const MarkerOffset& offset : calibrated.result.subject.offsets) {
    for (OsimMarker& marker : person.markers) {
      if (marker.name != offset.marker) continue;
      marker.p_BM += offset.offset;
      ++scaled.placed_markers;
    }
  }
  scaled.content = WriteOsimMarkers(scaled.content, model.file, document, person.markers);
  Diagnostics diagnostics(model.file);
  for (const OsimBody& body : ParseOsim(scaled.content, {}, &diagnostics).bodies) {
    scaled.mass += body.mass;
  }
  scaled.distance = calibrated.result.distance_after;
  return calibrated;
}

}  // namespace mmm_converter
