// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "common/fit/normal_equations.h"
#include "common/label/search/label_body.h"
#include "common/model/posture.h"

namespace mmm_converter {

/// What a fit to points without names moves: a whole body, a limb, a body that was predicted.
class MovingBody {
 public:
  MovingBody() = default;
  MovingBody(const MovingBody&) = delete;
  MovingBody& operator=(const MovingBody&) = delete;
  virtual ~MovingBody() = default;

  /// Its markers at a posture, 3 x markers [m]; the next step begins there.
  virtual const Eigen::Matrix3Xd& Place(const Posture& posture) = 0;
  /// Of each coordinate of a marker [m^2], where the posture may be off by `spread` [m].
  virtual const Eigen::VectorXd& Variances(double spread) = 0;
  /// One step from the posture placed last towards targets, 3 x markers [m], NaN: none. noise [m]:
  /// by marker.
  virtual void Step(const Eigen::Matrix3Xd& targets, const Eigen::VectorXd& noise,
                    Posture* posture) = 0;
  /// What the posture costs beside its points (MatchCosts).
  virtual double PostureCost(const Posture& /*posture*/) const { return 0; }
};

/// All of a body, with all of its markers (StepTowards).
class WholeBody final : public MovingBody {
 public:
  /// body must outlive it.
  explicit WholeBody(const LabelBody& body) : body_(body), equations_(body.kinematics) {}

  const Eigen::Matrix3Xd& Place(const Posture& posture) override {
    return equations_.Place(posture);
  }
  const Eigen::VectorXd& Variances(double spread) override;
  void Step(const Eigen::Matrix3Xd& targets, const Eigen::VectorXd& noise,
            Posture* posture) override;
  double PostureCost(const Posture& posture) const override;

 private:
  const LabelBody& body_;
  NormalEquations equations_;
  Eigen::VectorXd variances_;
};

/// Some joints of a body and the markers that these move, while the rest stays where it is.
class MovingLimb final : public MovingBody {
 public:
  /// body must outlive it.
  explicit MovingLimb(const LabelBody& body) : body_(body), at_(body.kinematics.MakeJacobian()) {}

  /// limb must outlive what follows.
  void Choose(const LabelBody::Limb& limb) { limb_ = &limb; }

  const Eigen::Matrix3Xd& Place(const Posture& posture) override;
  const Eigen::VectorXd& Variances(double spread) override;
  void Step(const Eigen::Matrix3Xd& targets, const Eigen::VectorXd& noise,
            Posture* posture) override {
    StepAbout(body_.natural_angles, targets, noise, posture);
  }
  double PostureCost(const Posture& posture) const override;
  /// As Step; joints that no target moves tend to `resting` angles, those of all joints.
  void StepAbout(const Eigen::VectorXd& resting, const Eigen::Matrix3Xd& targets,
                 const Eigen::VectorXd& noise, Posture* posture);

 private:
  const LabelBody& body_;
  const LabelBody::Limb* limb_ = nullptr;
  MarkerJacobian at_;
  Eigen::Matrix3Xd places_;
  Eigen::VectorXd variances_;
  Eigen::MatrixXd H_, J_;
  Eigen::VectorXd g_;
};

}  // namespace mmm_converter
