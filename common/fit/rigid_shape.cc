// SPDX-License-Identifier: MIT
#include "common/fit/rigid_shape.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

#include "common/math/rotation.h"
#include "common/math/statistics.h"
#include "common/support/error.h"
#include "common/support/text.h"
#include "common/support/units.h"

namespace mmm_converter {

using Eigen::Index;
using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::Ref;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

constexpr int kFewest = 3;  // markers of a pose

// Frames that are looked at; more make the shape hardly better. A marker that few of them show gets
// this many of its own.
constexpr int kMostShapeFrames = 1000;
constexpr int kFewestFrames = 20;

// Markers whose distance from a marker is looked at; more say hardly more of a frame.
constexpr int kMostPartners = 20;

// A frame whose distances between markers differ by more than this many times what is usual is
// left out; so are points off a line by less than as much. What no system resolves is the least.
constexpr double kUnusual = 3;
constexpr double kResolution = 1e-5;  // [m]
// Points are on a line where they are nearer to it than this share of their extent.
constexpr double kThinnest = 1e-3;

constexpr int kMostIterations = 200;
constexpr double kConverged = 1e-9;  // [m]

// Models are refused beyond.
constexpr double kFarthestMarker = 10;  // [m]

bool IsPoint(const Ref<const Vector3d>& p) { return p.allFinite(); }

int CountPoints(const Ref<const Matrix3Xd>& points) {
  int count = 0;
  for (Index i = 0; i < points.cols(); ++i) count += IsPoint(points.col(i));
  return count;
}

Vector3d MeanPoint(const Ref<const Matrix3Xd>& points) {
  Vector3d sum = Vector3d::Zero();
  for (Index i = 0; i < points.cols(); ++i) {
    if (IsPoint(points.col(i))) sum += points.col(i);
  }
  return sum / CountPoints(points);
}

// Root mean square along the three principal axes, the largest first [m].
Vector3d PrincipalExtents(const Ref<const Matrix3Xd>& points) {
  const Vector3d mean = MeanPoint(points);
  Matrix3d scatter = Matrix3d::Zero();
  for (Index i = 0; i < points.cols(); ++i) {
    if (!IsPoint(points.col(i))) continue;
    const Vector3d p = points.col(i) - mean;
    scatter += p * p.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(scatter / CountPoints(points),
                                                      Eigen::EigenvaluesOnly);
  return eigen.eigenvalues().reverse().cwiseMax(0).cwiseSqrt();
}

class ShapeEstimator {
 public:
  explicit ShapeEstimator(const MarkerSequence& recording) : recording_(recording) {
    TakeFrames();
    LeaveOutUnusualFrames();
  }

  RigidShape Estimate() {
    const int start = FindStart();
    shape_ = frames_[start].colwise() - MeanPoint(frames_[start]);
    while (Improve().adds_markers) {
    }
    for (int i = 0; i < kMostIterations && Improve().farthest > kConverged; ++i) {
    }
    return Finish(start);
  }

 private:
  struct Step {
    bool adds_markers = false;  // whose places were not known
    double farthest = 0;        // that a known place moved [m]
  };

  // Frames that repeat the one before say nothing more.
  std::vector<int> FindUsableFrames() const {
    std::vector<int> usable;
    int most = 0;
    for (int k = 0; k < recording_.num_frames(); ++k) {
      const int seen = CountPoints(recording_.frame(k));
      most = std::max(most, seen);
      if (seen < kFewest) continue;
      const bool is_repeated =
          !usable.empty() && IsSame(recording_.frame(usable.back()), recording_.frame(k));
      if (!is_repeated) usable.push_back(k);
    }
    if (!usable.empty()) return usable;
    throw Error(
        fmt::format("the pose of a rigid object needs three markers that are seen together; "
                    "the recording has {} ({}), at most {} in a frame",
                    recording_.num_labels(), FirstNames(recording_.labels()), most));
  }

  static bool IsSame(const Ref<const Matrix3Xd>& a, const Ref<const Matrix3Xd>& b) {
    for (Index i = 0; i < a.cols(); ++i) {
      if (IsPoint(a.col(i)) != IsPoint(b.col(i))) return false;
      if (IsPoint(a.col(i)) && a.col(i) != b.col(i)) return false;
    }
    return true;
  }

  void TakeFrames() {
    const std::vector<int> usable = FindUsableFrames();
    std::set<int> chosen = Spread(usable, kMostShapeFrames);
    for (int i = 0; i < recording_.num_labels(); ++i) {
      const auto is_seen = [&](int k) { return IsPoint(recording_.frame(k).col(i)); };
      if (std::count_if(chosen.begin(), chosen.end(), is_seen) >= kFewestFrames) continue;
      std::vector<int> own;
      std::copy_if(usable.begin(), usable.end(), std::back_inserter(own), is_seen);
      chosen.merge(Spread(own, kFewestFrames));
    }
    frames_.reserve(chosen.size());
    for (const int k : chosen) frames_.emplace_back(recording_.frame(k));
  }

  static std::set<int> Spread(const std::vector<int>& frames, std::size_t most) {
    std::set<int> spread;
    const std::size_t count = std::min(frames.size(), most);
    for (std::size_t i = 0; i < count; ++i) spread.insert(frames[i * frames.size() / count]);
    return spread;
  }

  // Of each marker and those after it: the median over the frames; NaN: never seen together.
  Eigen::MatrixXd UsualDistances() const {
    const int labels = recording_.num_labels();
    Eigen::MatrixXd usual = Eigen::MatrixXd::Constant(kMostPartners, labels, kNaN);
    std::vector<double> distances(frames_.size());
    for (int i = 0; i < labels; ++i) {
      for (int p = 0; p < std::min(kMostPartners, labels - 1 - i); ++p) {
        for (std::size_t k = 0; k < frames_.size(); ++k) {
          distances[k] = (frames_[k].col(i) - frames_[k].col(i + 1 + p)).norm();
        }
        usual(p, i) = Median(distances);
      }
    }
    return usual;
  }

  void LeaveOutUnusualFrames() {
    const Eigen::MatrixXd usual = UsualDistances();
    std::vector<double> strains(frames_.size(), 0.0);
    for (std::size_t k = 0; k < frames_.size(); ++k) {
      const Matrix3Xd& frame = frames_[k];
      for (Index i = 0; i < frame.cols(); ++i) {
        for (Index p = 0; p < std::min<Index>(kMostPartners, frame.cols() - 1 - i); ++p) {
          const double distance = (frame.col(i) - frame.col(i + 1 + p)).norm();
          const double strain = std::abs(distance - usual(p, i));
          if (std::isfinite(strain)) strains[k] = std::max(strains[k], strain);
        }
      }
    }
    tolerance_ = std::max(kUnusual * Median(strains), kResolution);
    std::vector<Matrix3Xd> kept;
    kept.reserve(frames_.size());
    for (std::size_t k = 0; k < frames_.size(); ++k) {
      if (strains[k] <= tolerance_) kept.push_back(std::move(frames_[k]));
    }
    frames_ = std::move(kept);
  }

  bool DeterminesPose(const Matrix3Xd& points) const {
    if (CountPoints(points) < kFewest) return false;
    const Vector3d extents = PrincipalExtents(points);
    return extents[1] > std::max(tolerance_, kThinnest * extents[0]);
  }

  // The first of the frames that show most markers.
  int FindStart() const {
    int start = -1;
    int most = 0;
    for (std::size_t k = 0; k < frames_.size(); ++k) {
      const int seen = CountPoints(frames_[k]);
      if (seen <= most || !DeterminesPose(frames_[k])) continue;
      start = static_cast<int>(k);
      most = seen;
    }
    if (start < 0) ThrowNoStart();
    return start;
  }

  [[noreturn]] void ThrowNoStart() const {
    constexpr double kBesideALine = 0.1;  // of the extent along it
    const bool is_line = std::none_of(frames_.begin(), frames_.end(), [](const Matrix3Xd& frame) {
      const Vector3d extents = PrincipalExtents(frame);
      return extents[1] > kBesideALine * extents[0];
    });
    const std::string names = FirstNames(recording_.labels());
    if (is_line) {
      throw Error(
          fmt::format("the markers ({}) stand on a line, to within {:.2g} mm: turns about it can't "
                      "be seen; one more marker beside it is needed",
                      names, 1e3 * tolerance_));
    }
    throw Error(
        fmt::format("the markers ({}) are no rigid object: in most frames distances between them "
                    "differ by {:.2g} mm or more from their medians",
                    names, 1e3 * tolerance_ / kUnusual));
  }

  // What a frame shows of the markers whose places are known.
  Matrix3Xd KnownPoints(const Matrix3Xd& frame) const {
    Matrix3Xd known = frame;
    for (Index i = 0; i < known.cols(); ++i) {
      if (!IsPoint(shape_.col(i))) known.col(i).setConstant(kNaN);
    }
    return known;
  }

  Isometry3d PoseIn(const Matrix3Xd& known) const {
    Matrix3Xd places = shape_;
    for (Index i = 0; i < places.cols(); ++i) {
      if (!IsPoint(places.col(i))) places.col(i).setZero();
    }
    return FitRigidPose(places, known, VectorXd::Ones(places.cols()));
  }

  // Each place becomes the mean of where the frames have it.
  Step Improve() {
    Matrix3Xd sum = Matrix3Xd::Zero(3, shape_.cols());
    VectorXd count = VectorXd::Zero(shape_.cols());
    for (const Matrix3Xd& frame : frames_) {
      const Matrix3Xd known = KnownPoints(frame);
      if (!DeterminesPose(known)) continue;
      const Isometry3d X_OW = PoseIn(known).inverse();
      for (Index i = 0; i < frame.cols(); ++i) {
        if (!IsPoint(frame.col(i))) continue;
        sum.col(i) += X_OW * Vector3d(frame.col(i));
        count[i] += 1;
      }
    }
    Step step;
    for (Index i = 0; i < shape_.cols(); ++i) {
      if (count[i] == 0) continue;
      const Vector3d place = sum.col(i) / count[i];
      if (IsPoint(shape_.col(i))) {
        step.farthest = std::max(step.farthest, (place - shape_.col(i)).norm());
      } else {
        step.adds_markers = true;
      }
      shape_.col(i) = place;
    }
    return step;
  }

  RigidShape Finish(int start) {
    const Matrix3d R_WO = PoseIn(KnownPoints(frames_[start])).linear();
    shape_ = (R_WO * (shape_.colwise() - MeanPoint(shape_))).eval();
    RigidShape result;
    double squares = 0;
    int points = 0;
    for (const Matrix3Xd& frame : frames_) {
      const Matrix3Xd known = KnownPoints(frame);
      if (!DeterminesPose(known)) continue;
      ++result.frames;
      const Matrix3Xd away = PoseIn(known) * shape_ - known;
      for (Index i = 0; i < away.cols(); ++i) {
        if (!IsPoint(away.col(i))) continue;
        squares += away.col(i).squaredNorm();
        ++points;
      }
    }
    result.distance = std::sqrt(squares / points);
    const double radius = RadiusOf(shape_);
    if (result.distance > kMostStray * radius) {
      throw Error(
          fmt::format("the {} markers are no rigid object: they stray {:.0f} mm from their best "
                      "common shape of {:.0f} mm (root mean square radius)",
                      recording_.num_labels(), 1e3 * result.distance, 1e3 * radius));
    }
    for (int i = 0; i < recording_.num_labels(); ++i) {
      if (IsPoint(shape_.col(i))) result.labels.push_back(i);
    }
    result.p_OM = shape_(Eigen::all, result.labels);
    const double farthest = result.p_OM.colwise().norm().maxCoeff();
    if (farthest > kFarthestMarker) {
      throw Error(
          fmt::format("the markers ({}) stand up to {:.1f} m from their mean, more than {} m",
                      FirstNames(recording_.labels()), farthest, kFarthestMarker));
    }
    return result;
  }

  const MarkerSequence& recording_;
  std::vector<Matrix3Xd> frames_;
  double tolerance_ = 0;  // [m]
  Matrix3Xd shape_;       // by label; NaN: not yet known
};

}  // namespace

Isometry3d FitRigidPose(const Ref<const Matrix3Xd>& p_OM, const Ref<const Matrix3Xd>& z,
                        const Ref<const VectorXd>& weights) {
  double total = 0;
  Vector3d center_z = Vector3d::Zero();
  Vector3d center_p = Vector3d::Zero();
  for (Index m = 0; m < z.cols(); ++m) {
    if (!z.col(m).allFinite()) continue;
    total += weights[m];
    center_z += weights[m] * z.col(m);
    center_p += weights[m] * p_OM.col(m);
  }
  center_z /= total;
  center_p /= total;
  Matrix3d correlation = Matrix3d::Zero();
  for (Index m = 0; m < z.cols(); ++m) {
    if (!z.col(m).allFinite()) continue;
    correlation += weights[m] * (z.col(m) - center_z) * (p_OM.col(m) - center_p).transpose();
  }
  const Matrix3d R = NearestRotation(correlation);
  Isometry3d X = Isometry3d::Identity();
  X.linear() = R;
  X.translation() = center_z - R * center_p;
  return X;
}

double RadiusOf(const Ref<const Matrix3Xd>& points) { return PrincipalExtents(points).norm(); }

double DistanceFromLine(const Ref<const Matrix3Xd>& points) {
  return CountPoints(points) < kFewest ? 0 : PrincipalExtents(points).tail<2>().norm();
}

RigidShape EstimateRigidShape(const MarkerSequence& recording) {
  return ShapeEstimator(recording).Estimate();
}

}  // namespace mmm_converter
