// SPDX-License-Identifier: MIT
#include "common/calibrate/landmark_body.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/math/square.h"
#include "common/math/statistics.h"
#include "common/model/forward_kinematics.h"
#include "common/motion/flat_frames.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr int kMostFrames = 500;  // that a median is taken of
// A length that is farther from the model's is a wrong label.
struct Share {
  double least = 0.7, most = 1.4;
};
// Toes are worn from the instep to the tip.
constexpr Share kOnFoot = {0.45, 1.5};
// Of distances between markers of a foot, as skin moves, and of their heights, as soles and floors
// are not quite flat [m].
constexpr double kDistanceDeviation = 0.003;
constexpr double kHeightDeviation = 0.004;
// Of places on a foot from the usual ones, by which feet differ [m].
constexpr double kWidthDeviation = 0.004;
constexpr double kLengthDeviation = 0.02;
constexpr std::size_t kFewestFlat = 5;   // frames
constexpr double kMostTilt = 0.03;       // [m] between markers, from the model's
constexpr double kInFront = 0.05;        // [m] of the malleolus: toes, which are worn up to
constexpr double kHighestInstep = 0.06;  // so far above the model's, on the instep [m]
// Slope of the markers of a foot against the model's, heel up: feet of 19 laboratories that stand
// flat have at most .12 (their toes' markers are higher), those that walk on toes by 15 degrees
// .18.
constexpr double kMostHeelUp = 0.14;
// What markers of both legs leave open of the difference of their lengths [m]: epicondyles and
// malleoli are found within 5 to 10 mm; a middle between two is better known.
constexpr double kOpenDifference = 0.015, kOpenDifferenceOfMiddles = 0.01;

double Offset(double length, double share, double rest_mm) {
  return share * length + rest_mm / kMillimetres;
}

bool IsShown(double length, double of_model, Share share = {}) {
  return length > share.least * of_model && length < share.most * of_model;
}

constexpr BodySide kSides[] = {BodySide::kLeft, BodySide::kRight};

/// A landmark that the recording has and the model has a marker for.
struct Seen {
  int label = -1;
  int marker = -1;
  bool is_malleolus = false;
};

class LandmarkBody {
 public:
  LandmarkBody(const TrackingSetup& setup, const NamedMarkers& names,
               const MarkerSequence& recording)
      : model_(*setup.model),
        names_(names),
        recording_(recording),
        step_(1 + recording.num_frames() / kMostFrames),
        X_WS_(SegmentPoses(model_, ZeroPosture(model_))) {}

  Subject Find() {
    FindPelvis();
    FindLegs();
    FindFeet();
    return std::move(body_);
  }

 private:
  struct Pelvis {
    double width = 0, depth = 0;
    Vector3d hip(BodySide side) const {  // from the middle of the anterior spines
      const double x = Offset(width, 0.33, 7.3);
      return {side == BodySide::kLeft ? -x : x, -Offset(depth, 0.24, 9.9),
              -Offset(width, 0.30, 10.9)};
    }
  };

  std::optional<Seen> Find(const char* landmark, BodySide side) const {
    const LandmarkTable& table = ShippedLandmarks();
    for (const NamedLabel& one : names_.labels) {
      if (one.marker.empty() || one.readings.empty()) continue;
      const LabelReading& reading = one.readings.front();
      const Landmark& known = table.landmarks()[static_cast<std::size_t>(reading.landmark)];
      if (reading.side != side || known.name != landmark) continue;
      const int label = recording_.FindLabel(one.label);
      const int marker = model_.FindMarker(one.marker);
      if (label < 0 || marker < 0) continue;
      const Seen seen{label, marker, known.part == "ankle"};
      if (std::isfinite(MedianOf([&](int k) { return At(k, seen).x(); }))) return seen;
    }
    return std::nullopt;
  }

  Vector3d At(int k, const Seen& one) const { return recording_.frame(k).col(one.label); }
  Vector3d AtRest(const Seen& one) const {
    const ModelMarker& marker = model_.markers()[static_cast<std::size_t>(one.marker)];
    return X_WS_[static_cast<std::size_t>(marker.segment)] * marker.p_SM;
  }

  /// The median over the frames of what may be NaN; NaN where hardly any frame shows it.
  template <class Value>
  double MedianOf(const Value& value) const {
    std::vector<double> values;
    for (int k = 0; k < recording_.num_frames(); k += step_) {
      const double one = value(k);
      if (std::isfinite(one)) values.push_back(one);
    }
    return values.empty() ? kNaN : Median(values);
  }
  double Distance(const Seen& a, const Seen& b) const {
    return MedianOf([&](int k) { return (At(k, a) - At(k, b)).norm(); });
  }

  void FindPelvis();
  /// Columns: to the right, forward, up; and the middle of the anterior spines; NaN: not seen.
  std::pair<Matrix3d, Vector3d> PelvisFrame(int k) const;
  Vector3d Back(int k) const;
  void PlaceOnPelvis(const Seen& one, const Vector3d& p_WM);

  struct Limb {
    double thigh = kNaN, shank = kNaN;  // [m]
    bool is_middle = false;             // between epicondyles, and between malleoli
  };
  Limb FindLimb(BodySide side) const;
  void FindLegs();
  struct Foot {
    std::vector<Seen> markers;
    std::vector<double> heights;  // above the first where the foot is flat; empty: not known
    double heel_up = 0;           // slope of the markers against the model's, where they are lowest
  };
  std::vector<Seen> FindFootMarkers(BodySide side) const;
  void MeasureHeights(Foot* foot) const;
  void FindFeet();
  void PlaceOnFoot(const Foot& foot);

  double LengthOf(const std::string& segment) const {
    const int index = model_.FindSegment(segment);
    return index < 0 ? kNaN
                     : model_.segments()[static_cast<std::size_t>(index)].X_PF.translation().norm();
  }
  void Scale(const std::string& segment, double length) {
    const double of_model = LengthOf(segment);
    if (IsShown(length, of_model)) body_.scales.push_back({segment, length / of_model, 0, 0});
  }
  double ScaleOf(const std::string& segment) const {
    for (const SegmentScale& one : body_.scales) {
      if (one.segment == segment) return one.scale;
    }
    return 1;
  }
  void Move(const Seen& one, const Vector3d& offset) {
    MarkerOffset moved;
    moved.marker = model_.markers()[static_cast<std::size_t>(one.marker)].name;
    moved.offset = offset;
    body_.offsets.push_back(std::move(moved));
  }

  const KinematicModel& model_;
  const NamedMarkers& names_;
  const MarkerSequence& recording_;
  int step_;
  std::vector<Eigen::Isometry3d> X_WS_;  // model, at zero
  std::optional<Pelvis> pelvis_;
  std::optional<Seen> front_[2], back_[2], sacrum_;
  Eigen::Vector2d ramp_ = Eigen::Vector2d::Zero();
  Subject body_;
};

constexpr const char* kHips[] = {"LHsegment_joint", "RHsegment_joint"};
constexpr const char* kKnees[] = {"LKsegment_joint", "RKsegment_joint"};
constexpr const char* kAnkles[] = {"LAsegment_joint", "RAsegment_joint"};

Vector3d LandmarkBody::Back(int k) const {
  if (back_[0] && back_[1]) {
    Vector3d middle = 0.5 * (At(k, *back_[0]) + At(k, *back_[1]));
    if (middle.allFinite() || !sacrum_) return middle;
  }
  return sacrum_ ? At(k, *sacrum_) : Vector3d::Constant(kNaN);
}

std::pair<Matrix3d, Vector3d> LandmarkBody::PelvisFrame(int k) const {
  const Vector3d left = At(k, *front_[0]), right = At(k, *front_[1]);
  const Vector3d middle = 0.5 * (left + right);
  Matrix3d R;
  R.col(0) = (right - left).normalized();
  R.col(2) = R.col(0).cross(middle - Back(k)).normalized();
  R.col(1) = R.col(2).cross(R.col(0));
  return {R, middle};
}

void LandmarkBody::PlaceOnPelvis(const Seen& one, const Vector3d& p_WM) {
  const ModelMarker& marker = model_.markers()[static_cast<std::size_t>(one.marker)];
  const std::string& segment = model_.segments()[static_cast<std::size_t>(marker.segment)].name;
  // The segment itself moves with its scale.
  const double scale = ScaleOf(segment);
  Eigen::Isometry3d X_WS = X_WS_[static_cast<std::size_t>(marker.segment)];
  X_WS.translation() *= scale;
  Move(one, X_WS.inverse() * p_WM - scale * marker.p_SM);
}

void LandmarkBody::FindPelvis() {
  for (int s = 0; s < 2; ++s) {
    front_[s] = Find("anterior iliac spine", kSides[s]);
    back_[s] = Find("posterior iliac spine", kSides[s]);
  }
  sacrum_ = Find("sacrum", BodySide::kNone);
  if (!front_[0] || !front_[1] || (!sacrum_ && !(back_[0] && back_[1]))) return;
  Pelvis pelvis;
  pelvis.width = Distance(*front_[0], *front_[1]);
  pelvis.depth = MedianOf(
      [&](int k) { return (0.5 * (At(k, *front_[0]) + At(k, *front_[1])) - Back(k)).norm(); });
  const Vector3d in_front = 0.5 * (AtRest(*front_[0]) + AtRest(*front_[1]));
  const Vector3d behind =
      sacrum_ ? AtRest(*sacrum_) : 0.5 * (AtRest(*back_[0]) + AtRest(*back_[1]));
  if (!IsShown(pelvis.width, (AtRest(*front_[0]) - AtRest(*front_[1])).norm()) ||
      !IsShown(pelvis.depth, (in_front - behind).norm())) {
    return;
  }
  pelvis_ = pelvis;
  for (int s = 0; s < 2; ++s) Scale(kHips[s], std::abs(pelvis.hip(kSides[s]).x()));
  // The middle of the hips is the model's root.
  const Vector3d middle = {0, -pelvis.hip(BodySide::kLeft).y(), -pelvis.hip(BodySide::kLeft).z()};
  PlaceOnPelvis(*front_[0], middle - Vector3d(0.5 * pelvis.width, 0, 0));
  PlaceOnPelvis(*front_[1], middle + Vector3d(0.5 * pelvis.width, 0, 0));
  const Vector3d back = middle - Vector3d(0, pelvis.depth, 0);
  if (sacrum_) PlaceOnPelvis(*sacrum_, back);
  if (!back_[0] || !back_[1]) return;
  const double width = Distance(*back_[0], *back_[1]);
  if (!IsShown(width, (AtRest(*back_[0]) - AtRest(*back_[1])).norm())) return;
  PlaceOnPelvis(*back_[0], back - Vector3d(0.5 * width, 0, 0));
  PlaceOnPelvis(*back_[1], back + Vector3d(0.5 * width, 0, 0));
}

/// The length along a limb between two points of which the distance is measured, the one being
/// `across` and `along` beside the other's limb.
double LengthAlong(double distance, double across_squared, double along) {
  return along + std::sqrt(std::max(0.0, Square(distance) - across_squared));
}

LandmarkBody::Limb LandmarkBody::FindLimb(BodySide side) const {
  Limb limb;
  const int s = side == BodySide::kLeft ? 0 : 1;
  const auto knee = Find("lateral epicondyle of the femur", side);
  const auto knee_in = Find("medial epicondyle of the femur", side);
  const auto ankle = Find("lateral malleolus", side);
  const auto ankle_in = Find("medial malleolus", side);
  const auto middle = [&](int k, const std::optional<Seen>& out, const std::optional<Seen>& in) {
    if (out && in) return Vector3d(0.5 * (At(k, *out) + At(k, *in)));
    return out ? At(k, *out) : Vector3d::Constant(kNaN);
  };
  const auto at_rest = [&](const std::optional<Seen>& out, const std::optional<Seen>& in) {
    return in ? Vector3d(0.5 * (AtRest(*out) + AtRest(*in))) : AtRest(*out);
  };
  const int knee_segment = model_.FindSegment(kKnees[s]);
  const int ankle_segment = model_.FindSegment(kAnkles[s]);
  if (!knee || knee_segment < 0 || ankle_segment < 0) return limb;
  const Vector3d knee_centre = X_WS_[static_cast<std::size_t>(knee_segment)].translation();
  const Vector3d of_knee = at_rest(knee, knee_in) - knee_centre;
  if (pelvis_) {
    const double distance = MedianOf([&](int k) {
      const auto [R, front] = PelvisFrame(k);
      return (front + R * pelvis_->hip(side) - middle(k, knee, knee_in)).norm();
    });
    limb.thigh = LengthAlong(distance, of_knee.head<2>().squaredNorm(), of_knee.z());
  }
  if (!ankle) return limb;
  limb.is_middle = knee_in && ankle_in;
  const auto in_knee = limb.is_middle ? knee_in : std::nullopt;
  const auto in_ankle = limb.is_middle ? ankle_in : std::nullopt;
  const double distance = MedianOf(
      [&](int k) { return (middle(k, knee, in_knee) - middle(k, ankle, in_ankle)).norm(); });
  const Vector3d above = at_rest(knee, in_knee) - knee_centre;
  const Vector3d below =
      at_rest(ankle, in_ankle) - X_WS_[static_cast<std::size_t>(ankle_segment)].translation();
  limb.shank =
      LengthAlong(distance, (above - below).head<2>().squaredNorm(), below.z() - above.z());
  return limb;
}

void LandmarkBody::FindLegs() {
  const Limb left = FindLimb(BodySide::kLeft), right = FindLimb(BodySide::kRight);
  const double thigh = Mean(std::vector<double>{left.thigh, right.thigh});
  const double shank = Mean(std::vector<double>{left.shank, right.shank});
  // Legs differ by what is more than markers leave open.
  const double difference = left.thigh + left.shank - right.thigh - right.shank;
  const double open =
      left.is_middle && right.is_middle ? kOpenDifferenceOfMiddles : kOpenDifference;
  const double share = std::abs(difference) > open ? 1 - open / std::abs(difference) : 0;
  for (int s = 0; s < 2; ++s) {
    const Limb& own = s == 0 ? left : right;
    Scale(kKnees[s], share > 0 ? thigh + share * (own.thigh - thigh) : thigh);
    Scale(kAnkles[s], share > 0 ? shank + share * (own.shank - shank) : shank);
  }
}

std::vector<Seen> LandmarkBody::FindFootMarkers(BodySide side) const {
  std::vector<Seen> foot;
  for (const char* name :
       {"lateral malleolus", "medial malleolus", "heel", "head of the first metatarsal",
        "head of the second metatarsal", "head of the fifth metatarsal"}) {
    if (const auto one = Find(name, side)) foot.push_back(*one);
  }
  return foot;
}

void LandmarkBody::MeasureHeights(Foot* foot) const {
  const std::vector<Seen>& markers = foot->markers;
  std::vector<int> labels;
  labels.reserve(markers.size());
  for (const Seen& one : markers) labels.push_back(one.label);
  std::vector<std::vector<double>> above(markers.size());
  const Vector3d up = Vector3d(-ramp_.x(), -ramp_.y(), 1).normalized();
  for (const int k : FlatFrames(recording_, labels, ramp_)) {
    for (std::size_t i = 0; i < markers.size(); ++i) {
      above[i].push_back(up.dot(At(k, markers[i]) - At(k, markers[0])));
    }
  }
  if (above.empty() || above[0].size() < kFewestFlat) return;
  std::vector<double> heights;
  bool are_of_foot = true;
  double moment = 0, square = 0;  // of the line through how much higher markers are
  for (std::size_t i = 0; i < markers.size(); ++i) {
    heights.push_back(Median(above[i]));
    const Vector3d of_model = AtRest(markers[i]) - AtRest(markers[0]);
    const double higher = heights[i] - of_model.z();
    // On stairs the lowest places of a foot's markers are of different steps.
    const double highest = of_model.y() > kInFront ? kHighestInstep : kMostTilt;
    are_of_foot = are_of_foot && higher >= -kMostTilt && higher <= highest;
    moment += of_model.y() * higher;
    square += of_model.y() * of_model.y();
  }
  if (square > 0) foot->heel_up = -moment / square;
  if (are_of_foot) foot->heights = std::move(heights);
}

void LandmarkBody::FindFeet() {
  Foot feet[2];
  std::vector<int> labels;
  for (int s = 0; s < 2; ++s) {
    feet[s].markers = FindFootMarkers(kSides[s]);
    for (const Seen& one : feet[s].markers) labels.push_back(one.label);
  }
  ramp_ = FindRamp(recording_, labels);
  for (Foot& foot : feet) MeasureHeights(&foot);
  for (int s = 0; s < 2; ++s) {
    // Who walks on toes never has the heel on the floor, most of them on neither side.
    const bool is_other_up = feet[1 - s].heel_up > kMostHeelUp;
    if (feet[s].heel_up > (is_other_up ? kMostHeelUp / 2 : kMostHeelUp)) feet[s].heights.clear();
    PlaceOnFoot(feet[s]);
  }
}

void LandmarkBody::PlaceOnFoot(const Foot& measured) {
  const std::vector<Seen>& foot = measured.markers;
  if (foot.size() < 2) return;
  const std::vector<double>& heights = measured.heights;
  const auto n = static_cast<Eigen::Index>(foot.size());
  Eigen::Matrix3Xd rest(3, n);
  for (Eigen::Index i = 0; i < n; ++i) rest.col(i) = AtRest(foot[static_cast<std::size_t>(i)]);
  Eigen::Matrix3Xd p = rest;
  Eigen::MatrixXd distances = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < i; ++j) {
      distances(i, j) =
          Distance(foot[static_cast<std::size_t>(i)], foot[static_cast<std::size_t>(j)]);
    }
  }
  // Places that have the distances and heights, by Gauss-Newton steps. Feet differ in length, the
  // malleoli, at the joint, and widths hardly.
  constexpr int kSteps = 10;
  for (int step = 0; step < kSteps; ++step) {
    Eigen::MatrixXd H = Eigen::MatrixXd::Zero(3 * n, 3 * n);
    VectorXd g = VectorXd::Zero(3 * n);
    const auto add = [&](const VectorXd& slope, double residual, double deviation) {
      H += slope * slope.transpose() / Square(deviation);
      g += slope * residual / Square(deviation);
    };
    for (Eigen::Index i = 0; i < n; ++i) {
      const bool is_at_joint = foot[static_cast<std::size_t>(i)].is_malleolus;
      for (int axis = 0; axis < 3; ++axis) {
        VectorXd slope = VectorXd::Zero(3 * n);
        slope[3 * i + axis] = 1;
        add(slope, rest(axis, i) - p(axis, i),
            is_at_joint || axis == 0 ? kWidthDeviation : kLengthDeviation);
      }
      if (i > 0 && !heights.empty()) {
        VectorXd slope = VectorXd::Zero(3 * n);
        slope[3 * i + 2] = 1;
        slope[2] = -1;
        const double height = heights[static_cast<std::size_t>(i)];
        add(slope, height - (p(2, i) - p(2, 0)), kHeightDeviation);
      }
      for (Eigen::Index j = 0; j < i; ++j) {
        const Vector3d between = p.col(i) - p.col(j);
        if (!IsShown(distances(i, j), (rest.col(i) - rest.col(j)).norm(), kOnFoot)) continue;
        VectorXd slope = VectorXd::Zero(3 * n);
        slope.segment<3>(3 * i) = between.normalized();
        slope.segment<3>(3 * j) = -between.normalized();
        add(slope, distances(i, j) - between.norm(), kDistanceDeviation);
      }
    }
    p.reshaped() += H.ldlt().solve(g);
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    const Seen& one = foot[static_cast<std::size_t>(i)];
    const int segment = model_.markers()[static_cast<std::size_t>(one.marker)].segment;
    Move(one,
         X_WS_[static_cast<std::size_t>(segment)].linear().transpose() * (p.col(i) - rest.col(i)));
  }
}

}  // namespace

Subject FindLandmarkBody(const TrackingSetup& setup, const NamedMarkers& names,
                         const MarkerSequence& recording) {
  return LandmarkBody(setup, names, recording).Find();
}

}  // namespace mmm_converter
