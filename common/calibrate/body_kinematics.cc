// SPDX-License-Identifier: MIT
#include "common/calibrate/body_kinematics.h"

#include <utility>

#include "common/model/forward_kinematics.h"
#include "common/model/subject.h"
#include "common/model/untold_joints.h"

namespace mmm_converter {

BodyKinematics::BodyKinematics(const KinematicModel& model, std::vector<int> joints,
                               std::vector<MarkerIx> markers)
    : model_(model),
      joints_(std::move(joints)),
      markers_(std::move(markers)),
      untold_(UntoldJoints(model, markers_)),
      lengths_(FindSegmentLengths(model, joints_, markers_)) {
  const auto num_scales = static_cast<Eigen::Index>(lengths_.segments.size());
  const auto num_markers = static_cast<Eigen::Index>(markers_.size());
  below_.setConstant(num_scales, num_markers, false);
  for (Eigen::Index m = 0; m < num_markers; ++m) {
    for (int s = model.markers()[markers_[m]].segment; s >= 0; s = model.segments()[s].parent) {
      for (Eigen::Index i = 0; i < num_scales; ++i) {
        if (lengths_.segments[i] == s) below_(i, m) = true;
      }
    }
  }
  SetBody(ModelBody());
}

BodyKinematics::BodyKinematics(const KinematicModel& model, std::vector<int> joints,
                               std::vector<MarkerIx> markers, BodySizes sizes)
    : model_(model),
      joints_(std::move(joints)),
      markers_(std::move(markers)),
      lengths_(std::move(sizes.lengths)),
      lines_(std::move(sizes.lines)),
      mirrors_(std::move(sizes.mirrors)),
      rescale_(std::move(sizes.rescale)) {
  const auto num_scales = static_cast<Eigen::Index>(lengths_.segments.size());
  sized_.emplace_back(model_, joints_, markers_);
  for (Eigen::Index i = 0; i < num_scales; ++i) {
    const Eigen::VectorXd larger =
        Eigen::VectorXd::Ones(num_scales) + Eigen::VectorXd::Unit(num_scales, i);
    sized_.emplace_back(rescale_(larger), joints_, markers_);
  }
  SetBody(ModelBody());
}

Body BodyKinematics::ModelBody() const {
  return {Eigen::VectorXd::Ones(static_cast<Eigen::Index>(lengths_.segments.size())),
          Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(markers_.size()))};
}

void BodyKinematics::SetBody(const Body& body) {
  if (rescale_) {
    ModelDescription fitted = DescriptionOf(rescale_(body.scales));
    for (std::size_t m = 0; m < markers_.size(); ++m) {
      fitted.markers[markers_[m]].p_SM += body.offsets.col(static_cast<Eigen::Index>(m));
    }
    fitted_ = std::make_unique<KinematicModel>(std::move(fitted));
    kinematics_ = std::make_unique<MarkerKinematics>(*fitted_, joints_, markers_, untold_);
    return;
  }
  Subject subject;
  for (std::size_t i = 0; i < lengths_.segments.size(); ++i) {
    subject.scales.push_back({model_.segments()[lengths_.segments[i]].name,
                              body.scales[static_cast<Eigen::Index>(i)], 0, 0});
  }
  for (std::size_t m = 0; m < markers_.size(); ++m) {
    MarkerOffset offset;
    offset.marker = model_.markers()[markers_[m]].name;
    offset.offset = body.offsets.col(static_cast<Eigen::Index>(m));
    subject.offsets.push_back(offset);
  }
  fitted_ = std::make_unique<KinematicModel>(FitToSubject(model_, subject));
  kinematics_ = std::make_unique<MarkerKinematics>(*fitted_, joints_, markers_, untold_);
}

BodyJacobian BodyKinematics::MakeJacobian() const {
  BodyJacobian result;
  result.posture = kinematics_->MakeJacobian();
  const auto num_markers = static_cast<Eigen::Index>(markers_.size());
  result.R_WS.resize(markers_.size());
  result.J_scales.setZero(3 * num_markers, static_cast<Eigen::Index>(lengths_.segments.size()));
  if (!sized_.empty()) result.sized = sized_.front().MakeJacobian();
  return result;
}

void BodyKinematics::Compute(const Posture& posture, BodyJacobian* result) const {
  kinematics_->ComputeMarkers(posture.position, posture.orientation.toRotationMatrix(),
                              posture.joint_angles, &result->posture);
  kinematics_->ComputeJacobian(&result->posture);
  Posture full = ZeroPosture(*fitted_);
  full.position = posture.position;
  full.orientation = posture.orientation;
  full.joint_angles(joints_) = posture.joint_angles;
  const auto X_WS = SegmentPoses(*fitted_, full);
  for (std::size_t m = 0; m < markers_.size(); ++m) {
    result->R_WS[m] = X_WS[model_.markers()[markers_[m]].segment].linear();
  }
  if (rescale_) {
    ComputeSizeSlopes(posture, result);
  } else {
    ComputeScaleSlopes(X_WS, result);
  }
}

void BodyKinematics::ComputeSizeSlopes(const Posture& posture, BodyJacobian* result) const {
  const Eigen::Matrix3d R_WS = posture.orientation.toRotationMatrix();
  for (std::size_t i = 0; i < sized_.size(); ++i) {
    sized_[i].ComputeMarkers(posture.position, R_WS, posture.joint_angles, &result->sized);
    if (i == 0) {
      result->of_model = result->sized.p_WM;
    } else {
      result->J_scales.col(static_cast<Eigen::Index>(i) - 1) =
          (result->sized.p_WM - result->of_model).reshaped();
    }
  }
}

void BodyKinematics::ComputeScaleSlopes(const std::vector<Eigen::Isometry3d>& X_WS,
                                        BodyJacobian* result) const {
  for (Eigen::Index i = 0; i < below_.rows(); ++i) {
    const int s = lengths_.segments[i];
    const Segment& segment = model_.segments()[s];
    const Eigen::Vector3d along = X_WS[segment.parent].linear() * segment.X_PF.translation();
    for (Eigen::Index m = 0; m < below_.cols(); ++m) {
      if (!below_(i, m)) continue;
      const ModelMarker& marker = model_.markers()[markers_[m]];
      auto slope = result->J_scales.block<3, 1>(3 * m, i);
      slope = along;
      if (marker.segment == s) slope += X_WS[s].linear() * marker.p_SM;
    }
  }
}

}  // namespace mmm_converter
