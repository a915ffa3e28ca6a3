// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <vector>

#include "common/calibrate/segment_lengths.h"
#include "common/model/kinematic_model.h"
#include "common/model/marker_kinematics.h"
#include "common/model/posture.h"

namespace mmm_converter {

/// What is the same in all frames: the body and where it wears its markers.
struct Body {
  Eigen::VectorXd scales;    ///< of SegmentLengths::segments
  Eigen::Matrix3Xd offsets;  ///< of the used markers [m], segment axes
};

/// Where the used markers of a posture are, and how that depends on posture and body.
struct BodyJacobian {
  MarkerJacobian posture;             ///< p_WM and its slopes by posture
  std::vector<Eigen::Matrix3d> R_WS;  ///< by marker: slope by its offset
  Eigen::MatrixXd J_scales;           ///< d p_WM / d scales, (3 markers) x scales [m]
  MarkerJacobian sized;               // scratch
  Eigen::Matrix3Xd of_model;          // scratch
};

/// Two used markers that are at the same place of both sides of the body.
struct MirroredPlaces {
  int a, b;
  Eigen::Matrix3d R_ba;  ///< makes a vector in axes of a's segment its mirror image in those of b's
};

/// Sizes of a model that are not lengths of single segments.
struct BodySizes {
  SegmentLengths lengths;  ///< its segments stand for what has a size, and name it
  /// The model with these scales. At any posture, markers go straight with each of them.
  std::function<KinematicModel(const Eigen::VectorXd& scales)> rescale;
  /// By used marker: the line to the one on the other side of a joint, a unit vector in axes of the
  /// segment; 0: none. Empty: of none.
  Eigen::Matrix3Xd lines;
  std::vector<MirroredPlaces> mirrors = {};  ///< each marker once at most
};

/// Marker kinematics of a body that changes. Compute may be called by several threads.
class BodyKinematics {
 public:
  /// joints, markers: indices of the model, which must outlive it.
  BodyKinematics(const KinematicModel& model, std::vector<int> joints,
                 std::vector<MarkerIx> markers);
  /// sizes: in place of FindSegmentLengths and FitToSubject.
  BodyKinematics(const KinematicModel& model, std::vector<int> joints,
                 std::vector<MarkerIx> markers, BodySizes sizes);

  const KinematicModel& model() const { return model_; }
  const std::vector<int>& joints() const { return joints_; }
  const std::vector<MarkerIx>& markers() const { return markers_; }
  const SegmentLengths& lengths() const { return lengths_; }
  const Eigen::Matrix3Xd& lines() const { return lines_; }  ///< of BodySizes
  const std::vector<MirroredPlaces>& mirrors() const { return mirrors_; }
  /// Of the body set last; the model's at first.
  const MarkerKinematics& kinematics() const { return *kinematics_; }
  const KinematicModel& fitted() const { return *fitted_; }

  /// The body of the model itself: scales 1, offsets 0.
  Body ModelBody() const;
  void SetBody(const Body& body);

  BodyJacobian MakeJacobian() const;
  /// posture: tracked joints.
  void Compute(const Posture& posture, BodyJacobian* result) const;

 private:
  void ComputeScaleSlopes(const std::vector<Eigen::Isometry3d>& X_WS, BodyJacobian* result) const;
  void ComputeSizeSlopes(const Posture& posture, BodyJacobian* result) const;

  const KinematicModel& model_;
  std::vector<int> joints_;
  std::vector<MarkerIx> markers_;
  std::vector<int> untold_;  // by the markers at the model's places, wherever they are moved
  SegmentLengths lengths_;
  Eigen::Matrix3Xd lines_;
  std::vector<MirroredPlaces> mirrors_;
  std::function<KinematicModel(const Eigen::VectorXd&)> rescale_;  // empty: FitToSubject
  std::vector<MarkerKinematics> sized_;  // with rescale_: the model, then each scale larger by 1
  /// lengths_ x markers_: true where the marker is below the segment, or on it.
  Eigen::Matrix<bool, Eigen::Dynamic, Eigen::Dynamic> below_;
  std::unique_ptr<const KinematicModel> fitted_;
  std::unique_ptr<const MarkerKinematics> kinematics_;
};

}  // namespace mmm_converter
