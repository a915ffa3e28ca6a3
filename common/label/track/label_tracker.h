// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/fit/normal_equations.h"
#include "common/label/search/body_search.h"
#include "common/label/search/label_body.h"
#include "common/label/search/linear_assignment.h"
#include "common/label/search/point_fit.h"
#include "common/label/track/body_watch.h"
#include "common/label/track/free_points.h"
#include "common/label/track/label_belief.h"
#include "common/label/track/point_tracks.h"
#include "common/math/padded_matrix.h"

namespace mmm_converter {

/// Names the points of one frame after the other by a body that moves on: a Kalman filter of the
/// posture whose update chooses the cheapest assignment of points, and follows where each marker is
/// worn. Points of others are ghosts to it. points: 3 x points [m], finite.
class LabelTracker {
 public:
  /// body must outlive the tracker.
  explicit LabelTracker(const LabelBody& body);

  /// Takes up a body that was found, at places that are not known better than the model has them.
  void Start(const BodyMatch& match);
  bool is_started() const { return belief_.P_qq.size() > 0; }

  /// A guess for each point: its marker, -1: none, and what that is worth as a cost. None at all:
  /// nothing is guessed.
  struct Hints {
    std::vector<int> markers = {};
    std::vector<double> worth = {};
  };

  /// The point of each marker dt [s] after the last frame, -1: none. Valid until the next call.
  const std::vector<int>& Track(const Eigen::Ref<const Eigen::Matrix3Xd>& points, double dt,
                                const Hints& hints);
  const std::vector<int>& Track(const Eigen::Ref<const Eigen::Matrix3Xd>& points, double dt) {
    return Track(points, dt, Hints());
  }

  /// Where the markers will be dt [s] after the last frame, 3 x markers [m], and the variance of a
  /// coordinate of each [m^2].
  void PredictPlaces(double dt, Eigen::Matrix3Xd* places, Eigen::VectorXd* variances);

  /// Where the last frame's posture has the markers, 3 x markers [m].
  const Eigen::Matrix3Xd& expected() const { return expected_; }
  /// Standard deviation of a coordinate of these [m].
  const Eigen::VectorXd& deviations() const { return deviations_; }

  /// Of a point [m] from the model's place of a marker in the last frame, axes of its link [m].
  Eigen::Vector3d OffsetOf(int marker, const Eigen::Vector3d& p_WP) const {
    return at_.R_WL[body_.kinematics.link_of_marker(marker)].transpose() *
           (p_WP - at_.p_WM.col(marker));
  }

  /// What is known of a frame before its points are used.
  struct Prediction {
    Posture posture;
    Eigen::MatrixXd information;  ///< inverse covariance of the dofs
    Eigen::Matrix3Xd offset;      ///< as LabelBelief has them
    Eigen::VectorXd offset_variance;
  };
  /// Of the last frame, with the offsets that are known after it.
  Prediction prediction() const {
    return {predicted_.posture, predicted_.information, belief_.offset, belief_.offset_variance};
  }

  /// The point of each marker in the last frame by its prediction together with that of a tracker
  /// that came from the other end of the recording. What is believed of the body stays as it is;
  /// expected(), deviations() and OffsetOf are of the posture between.
  const std::vector<int>& AssignBetween(const Eigen::Ref<const Eigen::Matrix3Xd>& points,
                                        const Prediction& other, const Hints& hints);

  const LabelBelief& belief() const { return belief_; }
  /// Time runs the other way from now on.
  void Reverse() {
    belief_.Reverse();
    follower_.Forget();
  }
  void Restore(const LabelBelief& belief) {
    belief_ = belief;
    follower_.Forget();
  }

 private:
  /// Of a symmetric, positive definite matrix, by its lower triangle.
  void Invert(const Eigen::Ref<const Eigen::MatrixXd>& A, Eigen::MatrixXd* inverse);
  /// What the belief says of the frame that it is at.
  void Predict();
  /// Expected places, and their covariances by P, at a posture. offset: of the markers.
  void Expect(const Posture& posture, const Eigen::MatrixXd& P, const Eigen::Matrix3Xd& offset);
  /// Soft assignment, where the posture is vague; then it is expected there.
  void AnnealVague(const Eigen::Ref<const Eigen::Matrix3Xd>& points, const Prediction& prediction,
                   const Eigen::MatrixXd& P, Posture* posture);
  void ComputeCosts(int marker, const Eigen::Ref<const Eigen::Matrix3Xd>& points,
                    double offset_variance);
  void Assign(const Eigen::Ref<const Eigen::Matrix3Xd>& points, const Prediction& prediction,
              const Hints& hints);
  /// A limb that could be anywhere is not taken up by a single point.
  void DropLonely();
  /// Another marker could have the point.
  bool CouldBeOther(int marker, Eigen::Index point) const;
  /// No free point could be the marker about as well.
  bool IsOnlyChoice(int marker) const;
  /// One step to the assigned points from `posture`, the prediction counting as it is sure.
  void Update(const Eigen::Ref<const Eigen::Matrix3Xd>& targets, const Eigen::VectorXd& noise,
              const Prediction& prediction, Posture* posture);
  /// Assignment and update in turns; leaves both behind, and what is expected after them. P: of the
  /// prediction, for which Expect was called at the posture.
  void Settle(const Eigen::Ref<const Eigen::Matrix3Xd>& points, const Prediction& prediction,
              const Eigen::MatrixXd& P, const Hints& hints, Posture* posture);
  /// Takes another posture nearby that explains the points much better by the markers' places
  /// alone.
  void LookNearby(const Eigen::Ref<const Eigen::Matrix3Xd>& points, const Hints& hints,
                  Posture* posture);
  /// Where the markers are worn, by the points that they have.
  void UpdateOffsets(const Eigen::Ref<const Eigen::Matrix3Xd>& points, double dt);
  /// Points that go on keep their names where nobody else wants them, as skin slides far in a
  /// throw. The posture does not follow them.
  void KeepContinued(const Eigen::Ref<const Eigen::Matrix3Xd>& points);

  const LabelBody& body_;
  LabelBelief belief_;
  LabelBelief::Scratch scratch_;
  BodySearch search_;
  BodyWatch watch_;
  FreePoints free_points_;
  PointFollower follower_;
  std::vector<int> continued_;  // by point: the marker that it was in the last frame, or -1
  std::vector<int> marker_of_point_;
  Prediction predicted_;  // of the last frame
  // What the last assignment was made at:
  MarkerJacobian at_;
  Eigen::Matrix3Xd offset_W_;  // in W
  Eigen::Matrix3Xd expected_;
  Eigen::VectorXd deviations_;
  std::vector<Eigen::Matrix3d> covariances_;  // of the expected places, by P
  Eigen::VectorXd first_deviations_;          // before any point was used
  Eigen::MatrixXd costs_;
  std::vector<int> point_of_marker_;
  Eigen::MatrixXd P_;  // of the update
  // Scratch:
  NormalEquations equations_;
  PointFit fit_;
  LinearAssignment assignment_;
  std::vector<int> used_;  // points of the last update, by marker
  Eigen::Matrix3Xd last_expected_;
  Eigen::Matrix3Xd targets_;
  Eigen::VectorXd noise_;
  PaddedMatrix padded_P_, moved_;
  PaddedMatrix factor_, root_, product_;  // of Invert
};

}  // namespace mmm_converter
