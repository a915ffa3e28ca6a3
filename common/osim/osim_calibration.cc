// SPDX-License-Identifier: MIT
#include "common/osim/osim_calibration.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "common/calibrate/body_kinematics.h"
#include "common/calibrate/calibration_frames.h"
#include "common/fit/posture_search.h"
#include "common/io/osim/osim_model_reader.h"
#include "common/io/osim/osim_scaling.h"
#include "common/io/osim/osim_subject.h"
#include "common/math/statistics.h"
#include "common/model/coordinate_map.h"
#include "common/model/forward_kinematics.h"
#include "common/model/kit_joints.h"
#include "common/osim/osim_sizes.h"

namespace mmm_converter {

using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

constexpr double kLeastSize = 0.4, kMostSize = 1.6, kSizeStep = 0.05;
// Two markers on the sides of a joint are so far apart [m]; it is so near the middle, by that.
constexpr double kLeastPair = 0.03, kMostPair = 0.16;
constexpr double kMostBeside = 0.25;
constexpr int kSpreadSteps = 2;
constexpr double kLeastSpread = 0.005, kMostSpread = 0.03;  // [m]
constexpr double kMedianOfSquares = 0.789;  // of the mean of three squares, by their expectation
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
  std::vector<Vector3d> Factors(double size, const VectorXd& scales) const;
  KinematicModel Scaled(double size, const VectorXd& scales) const;
  BodySizes Sizes(double size) const;
  VectorXd Ones() const {
    return VectorXd::Ones(3 * static_cast<Eigen::Index>(sizes_.bodies.size()));
  }

 private:
  std::vector<bool> BodiesWithMarkers() const;
  Eigen::Matrix3Xd PairLines() const;
  std::vector<MirroredPlaces> Mirrors() const;
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

std::vector<Vector3d> OsimCalibration::Factors(double size, const VectorXd& scales) const {
  std::vector<Vector3d> factors(document_.bodies.size(), Vector3d::Constant(size));
  for (std::size_t body = 0; body < factors.size(); ++body) {
    const Eigen::Index i = sizes_.size_of[body];
    if (i >= 0) factors[body] = size * scales.segment<3>(3 * i);
  }
  factors[0].setOnes();  // ground
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
      sizes.lengths.segments.insert(sizes.lengths.segments.end(), 3,
                                    reference_.markers()[marker].segment);
      break;
    }
  }
  sizes.lengths.are_of_axes = true;
  for (const auto& [left, right] : sizes_.mirror) {
    for (int i = 0; i < 3; ++i) sizes.lengths.mirror.emplace_back(3 * left + i, 3 * right + i);
  }
  sizes.lines = PairLines();
  sizes.mirrors = Mirrors();
  sizes.rescale = [this, size](const VectorXd& scales) { return Scaled(size, scales); };
  return sizes;
}

/// Two markers on sides of a joint, medial and lateral of a knee or ankle: on the bodies that it
/// connects, with it halfway between them.
Eigen::Matrix3Xd OsimCalibration::PairLines() const {
  const Posture rest = RestPosture(reference_);
  const std::vector<Eigen::Isometry3d> X_WS = SegmentPoses(reference_, rest);
  const Eigen::Matrix3Xd p_WM = MarkerPositions(reference_, rest);
  const auto count = static_cast<int>(markers_.size());
  Eigen::Matrix3Xd lines = Eigen::Matrix3Xd::Zero(3, count);
  for (const OsimJoint& joint : document_.joints) {
    const int segment = reference_.FindSegment(document_.bodies[joint.child].name);
    if (joint.parent == 0 || segment < 0) continue;
    const Vector3d p_WJ = X_WS[segment].translation();
    const auto is_beside = [&](int m) {
      const OsimMarker* source = SourceOf(markers_[m]);
      return source != nullptr && (source->body == joint.parent || source->body == joint.child);
    };
    std::pair<int, int> best(-1, -1);
    double least = kMostBeside;
    for (int a = 0; a < count; ++a) {
      for (int b = a + 1; b < count; ++b) {
        const Vector3d p_a = p_WM.col(markers_[a]), p_b = p_WM.col(markers_[b]);
        const double apart = (p_a - p_b).norm();
        const double beside = (0.5 * (p_a + p_b) - p_WJ).norm() / apart;
        if (!(apart >= kLeastPair && apart <= kMostPair && beside < least)) continue;
        if (!is_beside(a) || !is_beside(b)) continue;
        least = beside;
        best = {a, b};
      }
    }
    if (best.first < 0) continue;
    const Vector3d line =
        (p_WM.col(markers_[best.first]) - p_WM.col(markers_[best.second])).normalized();
    for (const int m : {best.first, best.second}) {
      const int own = reference_.markers()[markers_[m]].segment;
      lines.col(m) = X_WS[own].linear().transpose() * line;
    }
  }
  return lines;
}

/// Markers with the name of the other side, mirrored at the plane that is halfway between them.
std::vector<MirroredPlaces> OsimCalibration::Mirrors() const {
  const Posture rest = RestPosture(reference_);
  const std::vector<Eigen::Isometry3d> X_WS = SegmentPoses(reference_, rest);
  const Eigen::Matrix3Xd p_WM = MarkerPositions(reference_, rest);
  std::vector<MirroredPlaces> mirrors;
  Vector3d across = Vector3d::Zero();
  for (int a = 0; a < static_cast<int>(markers_.size()); ++a) {
    const int other =
        reference_.FindMarker(MirroredOsimName(reference_.markers()[markers_[a]].name));
    const auto found = std::find(markers_.begin() + a + 1, markers_.end(), MarkerIx(other));
    if (other < 0 || found == markers_.end()) continue;
    mirrors.push_back({a, static_cast<int>(found - markers_.begin()), Eigen::Matrix3d::Zero()});
    const Vector3d apart = p_WM.col(markers_[a]) - p_WM.col(other);
    across += across.dot(apart) < 0 ? Vector3d(-apart) : apart;
  }
  across.normalize();
  const Eigen::Matrix3d mirror = Eigen::Matrix3d::Identity() - 2 * across * across.transpose();
  for (MirroredPlaces& pair : mirrors) {
    const auto R_WS = [&](int m) {
      return X_WS[reference_.markers()[markers_[m]].segment].linear();
    };
    pair.R_ba = R_WS(pair.b).transpose() * mirror * R_WS(pair.a);
  }
  return mirrors;
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
  options.marker_deviation = 0.02;  // to begin with, as the next
  options.side_correlation = 0.5;
  options.height_deviation = 0.1;
  options.may_stand = true;
  return options;
}

namespace {

/// How far from the model's places this person's markers are worn, each coordinate [m]: what the
/// offsets and their deviations make most likely (Dempster et al. 1977), markers worn far off
/// counting as others.
double MarkerSpread(const Subject& subject) {
  std::vector<double> squares;
  for (const MarkerOffset& offset : subject.offsets) {
    squares.push_back((offset.offset.squaredNorm() + offset.standard_deviations.squaredNorm()) / 3);
  }
  return std::clamp(std::sqrt(Median(squares) / kMedianOfSquares), kLeastSpread, kMostSpread);
}

/// The file with the sizes found, and the markers where they were found.
ScaledOsim WritePerson(const NamedText& model, const OsimDocument& document,
                       const std::vector<Vector3d>& factors, const Subject& subject,
                       std::optional<double> mass, Warnings* warnings) {
  ScaledOsim scaled;
  OsimScaling scaling;
  scaling.mass = mass;
  for (std::size_t body = 1; body < factors.size(); ++body) {
    scaling.factors[document.bodies[body].name] = factors[body];
  }
  scaled.content = WriteOsimMarkers(model.content, model.file, document, document.markers);
  scaled.content = ScaleOsim(scaled.content, model.file, scaling, warnings);
  scaled.factors = std::move(scaling.factors);
  OsimDocument person = ScaleOsimDocument(document, factors);
  for (const MarkerOffset& offset : subject.offsets) {
    for (OsimMarker& marker : person.markers) {
      if (marker.name != offset.marker) continue;
      marker.p_BM += offset.offset;
      ++scaled.placed_markers;
    }
  }
  scaled.content = WriteOsimMarkers(scaled.content, model.file, document, person.markers);
  return scaled;
}

}  // namespace

CalibratedOsim CalibrateOsim(const NamedText& model, const OsimDocument& document,
                             const KinematicModel& reference, const std::vector<int>& joints,
                             const std::vector<CalibrationRecording>& recordings,
                             const OsimPersonFacts& person, const CalibrationOptions& options,
                             Warnings* warnings) {
  CalibratedOsim calibrated;
  const OsimCalibration calibration(document, model.file, reference, joints, recordings);
  calibrated.size = calibration.FindSize(recordings, options);
  const KinematicModel start = calibration.Scaled(calibrated.size, calibration.Ones());
  const auto calibrate = [&](const CalibrationOptions& assumed, Warnings* told) {
    BodyKinematics kinematics(start, joints, calibration.markers(),
                              calibration.Sizes(calibrated.size));
    return CalibrateBody(&kinematics, recordings, assumed, told);
  };
  CalibrationOptions assumed = options;
  for (int i = 0; i < kSpreadSteps; ++i) {
    const CalibrationResult found = calibrate(assumed, nullptr);
    assumed.marker_deviation = MarkerSpread(found.subject);
    assumed.side_correlation = found.side_correlation;
  }
  calibrated.result = calibrate(assumed, warnings);

  Subject& subject = calibrated.result.subject;
  VectorXd found = calibration.Ones();
  for (std::size_t i = 0; i < subject.scales.size(); ++i) {
    found[static_cast<Eigen::Index>(i)] = subject.scales[i].scale;
  }
  ScaledOsim& scaled = calibrated.scaled;
  scaled = WritePerson(model, document, calibration.Factors(calibrated.size, found), subject,
                       person.mass, warnings);
  Diagnostics diagnostics(model.file);
  const KinematicModel written =
      MakeOsimModel(ParseOsim(scaled.content, {}, &diagnostics), &diagnostics);
  subject.name = person.name;
  subject.height = person.height.value_or(0);
  subject.mass = scaled.mass = written.total_mass();
  scaled.content = WithOsimSubject(scaled.content, written, subject, person.program);
  const auto known = ParseOsimSubject(scaled.content, model.file, written, warnings);
  calibrated.model =
      std::make_shared<const KinematicModel>(known ? FitToSubject(written, *known) : written);
  scaled.distance = calibrated.result.distance_after;
  return calibrated;
}

}  // namespace mmm_converter
