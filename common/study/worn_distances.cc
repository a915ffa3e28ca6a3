// SPDX-License-Identifier: MIT
#include "common/study/worn_distances.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "common/calibrate/body_kinematics.h"
#include "common/calibrate/calibration_frames.h"
#include "common/math/square.h"
#include "common/math/statistics.h"
#include "common/study/told_frames.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr int kSteps = 2;  // the postures are those of a tracker; a third step changes little
// Standard deviations before the recording is seen.
constexpr double kSkin = 0.015;              // of a marker in its segment from frame to frame [m]
constexpr double kLength = 0.06;             // of a segment, relative
constexpr double kAllLengths = 0.03;         // of all segments together
constexpr double kLengthCorrelation = 0.97;  // of left and right
// A place of which the body tells less than this share is not judged in that direction.
constexpr double kLeastTold = 0.02;
// A marker that is so much farther from its own median place in a frame is another's there [m].
constexpr double kAstray = 0.15;
constexpr std::size_t kMostLabels = 150;  // the work grows with their square

/// The most likely body of some frames, postures being unknown; Gauss-Newton. The body is
/// [where each used marker is worn 3 [m]; lengths relative to the model's, less 1].
class WornBody {
 public:
  WornBody(const TrackingSetup& setup, const MarkerSequence& markers,
           const PoseTrajectory& trajectory)
      : markers_(markers),
        used_(UsedMarkers({{"", &markers, setup.assignments()}})),
        kinematics_(*setup.model, setup.joints, used_),
        assignments_(used_.size()),
        num_assignments_(static_cast<Index>(setup.assignments().size())),
        is_seen_(used_.size(), false),
        places_(3 * static_cast<Index>(used_.size())),
        frames_(LookedAt(markers.num_frames())),
        body_(VectorXd::Zero(places_ + static_cast<Index>(kinematics_.lengths().segments.size()))) {
    for (std::size_t i = 0; i < setup.assignments().size(); ++i) {
      const MarkerAssignment& one = setup.assignments()[i];
      const auto at = std::lower_bound(used_.begin(), used_.end(), one.marker) - used_.begin();
      assignments_[static_cast<std::size_t>(at)] = {static_cast<int>(i), one.label,
                                                    one.noise_scale};
    }
    for (const int k : frames_) {
      postures_.push_back(trajectory.postures[static_cast<std::size_t>(k)]);
    }
    FindAstray();
    MakePrior();
    for (int step = 0; step < kSteps; ++step) Step();
  }

  VectorXd Distances() const {
    VectorXd distances = VectorXd::Constant(num_assignments_, kNaN);
    for (std::size_t m = 0; m < used_.size(); ++m) {
      if (!is_seen_[m]) continue;
      const auto i = 3 * static_cast<Index>(m);
      const double variance = Square(Sigma(static_cast<Index>(m)));
      const Matrix3d told = Matrix3d::Identity() - covariance_.block<3, 3>(i, i) / variance;
      const Eigen::SelfAdjointEigenSolver<Matrix3d> axes(told);
      const Vector3d offset = axes.eigenvectors().transpose() * body_.segment<3>(i);
      const Vector3d shares = axes.eigenvalues().cwiseMax(kLeastTold);
      distances[assignments_[m].index] =
          kPlaceDeviation * std::sqrt(offset.cwiseAbs2().cwiseQuotient(shares).sum() / variance);
    }
    return distances;
  }

 private:
  struct Assignment {
    int index = 0, label = 0;
    double noise_scale = 1;
  };

  double Sigma(Index m) const {
    return kPlaceDeviation * assignments_[static_cast<std::size_t>(m)].noise_scale;
  }

  void MakePrior() {
    prior_.setZero(body_.size(), body_.size());
    const Index count = places_ / 3;
    for (Index m = 0; m < count; ++m) {
      prior_.diagonal().segment<3>(3 * m).setConstant(1 / Square(Sigma(m)));
    }
    const SegmentLengths& lengths = kinematics_.lengths();
    const auto n = static_cast<Index>(lengths.segments.size());
    MatrixXd covariance = Square(kLength) * MatrixXd::Identity(n, n);
    for (const auto& [left, right] : lengths.mirror) {
      covariance(left, right) = covariance(right, left) = kLengthCorrelation * Square(kLength);
    }
    covariance.array() += Square(kAllLengths);
    prior_.bottomRightCorner(n, n) = covariance.llt().solve(MatrixXd::Identity(n, n));
  }

  void FindAstray() {
    kinematics_.SetBody(kinematics_.ModelBody());
    BodyJacobian at = kinematics_.MakeJacobian();
    std::vector<Eigen::Matrix3Xd> places;  // by frame, in axes of segments
    for (std::size_t f = 0; f < frames_.size(); ++f) {
      kinematics_.Compute(postures_[f], &at);
      Eigen::Matrix3Xd& of_frame = places.emplace_back(3, places_ / 3);
      for (std::size_t m = 0; m < used_.size(); ++m) {
        const auto i = static_cast<Index>(m);
        of_frame.col(i) =
            at.R_WS[m].transpose() *
            (markers_.frame(frames_[f]).col(assignments_[m].label) - at.posture.p_WM.col(i));
      }
    }
    is_astray_.assign(frames_.size(), std::vector<bool>(used_.size(), false));
    for (std::size_t m = 0; m < used_.size(); ++m) {
      const auto i = static_cast<Index>(m);
      std::array<std::vector<double>, 3> all;
      for (const Eigen::Matrix3Xd& of_frame : places) {
        if (!IsSeen(of_frame.col(i))) continue;
        for (int axis = 0; axis < 3; ++axis) all[axis].push_back(of_frame(axis, i));
      }
      if (all[0].empty()) continue;
      const Vector3d usual(Median(all[0]), Median(all[1]), Median(all[2]));
      for (std::size_t f = 0; f < frames_.size(); ++f) {
        is_astray_[f][m] = (places[f].col(i) - usual).norm() > kAstray;
      }
    }
  }

  /// How a frame's posture follows the body's step.
  struct Following {
    MatrixXd slopes;
    VectorXd step;
  };

  /// Adds what a frame says of the body, its posture being eliminated.
  Following Add(std::size_t f, BodyJacobian* at, MatrixXd* H, VectorXd* g) {
    kinematics_.Compute(postures_[f], at);
    const auto all = at->posture.J_transposed.view();
    const auto frame = markers_.frame(frames_[f]);
    const Index n = body_.size() - places_;
    MatrixXd A = PostureInformation(kinematics_.kinematics(), postures_[f]).asDiagonal();
    MatrixXd J = MatrixXd::Zero(A.rows(), places_);
    MatrixXd W = MatrixXd::Zero(A.rows(), body_.size());
    VectorXd r = VectorXd::Zero(places_);
    for (std::size_t m = 0; m < used_.size(); ++m) {
      const auto z = frame.col(assignments_[m].label);
      if (!IsSeen(z) || is_astray_[f][m]) continue;
      is_seen_[m] = true;
      const auto i = 3 * static_cast<Index>(m);
      const double w = 1 / (kSkin * assignments_[m].noise_scale);
      const Matrix3d R = w * at->R_WS[m];
      const MatrixXd by_lengths = w * at->J_scales.middleRows<3>(i);
      J.middleCols<3>(i) = w * all.middleCols(i, 3);
      r.segment<3>(i) = w * (z - at->posture.p_WM.col(static_cast<Index>(m)));
      W.middleCols<3>(i) = J.middleCols<3>(i) * R;
      W.rightCols(n) += J.middleCols<3>(i) * by_lengths;
      H->block<3, 3>(i, i) += R.transpose() * R;
      H->block(places_, i, n, 3) += by_lengths.transpose() * R;
      H->bottomRightCorner(n, n) += by_lengths.transpose() * by_lengths;
      g->segment<3>(i) += R.transpose() * r.segment<3>(i);
      g->tail(n) += by_lengths.transpose() * r.segment<3>(i);
    }
    A.selfadjointView<Eigen::Lower>().rankUpdate(J);
    const Eigen::LLT<MatrixXd> factor(A);
    Following following;
    following.step = factor.solve(J * r);
    *g -= W.transpose() * following.step;
    factor.matrixL().solveInPlace(W);
    H->selfadjointView<Eigen::Lower>().rankUpdate(W.transpose(), -1);
    factor.matrixU().solveInPlace(W);
    following.slopes = std::move(W);
    return following;
  }

  void Step() {
    Body body = kinematics_.ModelBody();
    body.offsets = body_.head(places_).reshaped(3, Eigen::AutoSize);
    body.scales = (body.scales + body_.tail(body.scales.size()))
                      .cwiseMax(kLeastSegmentScale)
                      .cwiseMin(kLargestSegmentScale);
    kinematics_.SetBody(body);
    BodyJacobian at = kinematics_.MakeJacobian();
    MatrixXd H = prior_;
    VectorXd g = -prior_ * body_;
    std::vector<Following> following;
    for (std::size_t f = 0; f < frames_.size(); ++f) following.push_back(Add(f, &at, &H, &g));
    const Eigen::LLT<MatrixXd> factor(H);
    const VectorXd step = factor.solve(g);
    body_ += step;
    covariance_ = factor.solve(MatrixXd::Identity(H.rows(), H.cols()));
    const MarkerKinematics& joints = kinematics_.kinematics();
    for (std::size_t f = 0; f < frames_.size(); ++f) {
      const VectorXd own = following[f].step - following[f].slopes * step;
      postures_[f] = Retract(postures_[f], own);
      postures_[f].joint_angles =
          postures_[f].joint_angles.cwiseMax(joints.lower()).cwiseMin(joints.upper());
    }
  }

  const MarkerSequence& markers_;
  const std::vector<MarkerIx> used_;
  BodyKinematics kinematics_;
  std::vector<Assignment> assignments_;  // by used marker
  const Index num_assignments_;
  std::vector<bool> is_seen_;
  const Index places_;
  const std::vector<int> frames_;
  VectorXd body_;
  std::vector<Posture> postures_;
  std::vector<std::vector<bool>> is_astray_;  // by frame and used marker
  MatrixXd prior_, covariance_;
};

}  // namespace

Eigen::VectorXd WornDistances(const TrackingSetup& setup, const MarkerSequence& markers,
                              const PoseTrajectory& trajectory) {
  if (setup.assignments().size() > kMostLabels) {
    return Eigen::VectorXd::Constant(static_cast<Index>(setup.assignments().size()), kNaN);
  }
  return WornBody(setup, markers, trajectory).Distances();
}

}  // namespace mmm_converter
