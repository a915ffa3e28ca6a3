// SPDX-License-Identifier: MIT
#include "common/study/told_distances.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <vector>

#include "common/math/statistics.h"
#include "common/model/marker_kinematics.h"
#include "common/study/told_frames.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;

/// The frames' fits, linear about the postures.
class LinearFit {
 public:
  LinearFit(const TrackingSetup& setup, const MarkerSequence& markers)
      : setup_(setup),
        markers_(markers),
        kinematics_(*setup.model, setup.joints, MarkersOf(setup)),
        at_(kinematics_.MakeJacobian()) {}

  /// Adds the distance of each label that the frame shows.
  void AddFrame(int k, const Posture& posture, std::vector<std::vector<double>>* distances) {
    kinematics_.ComputeMarkers(posture.position, posture.orientation.toRotationMatrix(),
                               posture.joint_angles, &at_);
    kinematics_.ComputeJacobian(&at_);
    const auto all = at_.J_transposed.view();
    MatrixXd information = PostureInformation(kinematics_, posture).asDiagonal();
    const auto& assignments = setup_.assignments();
    const auto count = static_cast<Eigen::Index>(assignments.size());
    MatrixXd J_transposed = MatrixXd::Zero(kinematics_.num_dofs(), 3 * count);  // over sigma
    const auto frame = markers_.frame(k);
    for (Eigen::Index i = 0; i < count; ++i) {
      const MarkerAssignment& one = assignments[static_cast<std::size_t>(i)];
      if (!IsSeen(frame.col(one.label))) continue;
      J_transposed.middleCols<3>(3 * i) = all.middleCols(3 * i, 3) / Sigma(one);
    }
    information += J_transposed * J_transposed.transpose();
    const MatrixXd gain = information.llt().solve(J_transposed);
    for (Eigen::Index i = 0; i < count; ++i) {
      const MarkerAssignment& one = assignments[static_cast<std::size_t>(i)];
      if (!IsSeen(frame.col(one.label))) continue;
      const Vector3d r = (frame.col(one.label) - at_.p_WM.col(i)) / Sigma(one);
      const Matrix3d left = Matrix3d::Identity() - J_transposed.middleCols<3>(3 * i).transpose() *
                                                       gain.middleCols<3>(3 * i);
      (*distances)[static_cast<std::size_t>(i)].push_back(kPlaceDeviation *
                                                          std::sqrt(r.dot(left.llt().solve(r))));
    }
  }

 private:
  static std::vector<MarkerIx> MarkersOf(const TrackingSetup& setup) {
    std::vector<MarkerIx> markers;
    for (const MarkerAssignment& one : setup.assignments()) markers.push_back(one.marker);
    return markers;
  }

  static double Sigma(const MarkerAssignment& one) { return kPlaceDeviation * one.noise_scale; }

  const TrackingSetup& setup_;
  const MarkerSequence& markers_;
  MarkerKinematics kinematics_;
  MarkerJacobian at_;
};

}  // namespace

Eigen::VectorXd ToldDistances(const TrackingSetup& setup, const MarkerSequence& markers,
                              const PoseTrajectory& trajectory) {
  LinearFit fit(setup, markers);
  std::vector<std::vector<double>> distances(setup.assignments().size());
  for (const int k : LookedAt(markers.num_frames())) {
    fit.AddFrame(k, trajectory.postures[static_cast<std::size_t>(k)], &distances);
  }
  Eigen::VectorXd medians(static_cast<Eigen::Index>(distances.size()));
  for (std::size_t i = 0; i < distances.size(); ++i) {
    medians[static_cast<Eigen::Index>(i)] = distances[i].empty() ? kNaN : Median(distances[i]);
  }
  return medians;
}

}  // namespace mmm_converter
