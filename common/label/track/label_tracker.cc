// SPDX-License-Identifier: MIT
#include "common/label/track/label_tracker.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "common/label/search/posture_step.h"
#include "common/label/tuning.h"
#include "common/math/dense.h"
#include "common/math/rotation.h"
#include "common/math/square.h"
#include "common/support/units.h"

namespace mmm_converter {

using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::MatrixXd;
using Eigen::Ref;
using Eigen::Vector3d;
using Eigen::VectorXd;

LabelTracker::LabelTracker(const LabelBody& body)
    : body_(body),
      scratch_(body.kinematics.num_dofs()),
      search_(body),
      watch_(WatchTuning::kNearby),
      at_(body.kinematics.MakeJacobian()),
      equations_(body.kinematics),
      padded_P_(body.kinematics.num_dofs(), body.kinematics.num_dofs()),
      moved_(body.kinematics.num_dofs(), 3 * body.num_markers()),
      factor_(body.kinematics.num_dofs(), body.kinematics.num_dofs()),
      root_(body.kinematics.num_dofs(), body.kinematics.num_dofs()),
      product_(body.kinematics.num_dofs(), body.kinematics.num_dofs()) {
  point_of_marker_.assign(body.num_markers(), -1);
  offset_W_.setZero(3, body.num_markers());
  deviations_.setZero(body.num_markers());
  covariances_.resize(body.num_markers());
}

void LabelTracker::Start(const BodyMatch& match) { belief_ = BeliefAt(body_, match.posture); }

void LabelTracker::Invert(const Ref<const MatrixXd>& A, MatrixXd* inverse) {
  factor_.view() = A;
  Factorize(&factor_);
  root_.SetIdentity();
  DivideByTransposed(factor_, &root_);
  product_.SetZero();
  AddSquare(1, root_, &product_);
  *inverse = product_.view().selfadjointView<Eigen::Lower>();
}

void LabelTracker::PredictPlaces(double dt, Matrix3Xd* places, VectorXd* variances) {
  Expect(belief_.PostureAfter(body_, dt), belief_.P_qq, belief_.offset);
  *places = expected_;
  *variances = deviations_.array().square() + belief_.offset_variance.array() +
               body_.skin.array().square() + Square(dt * MovementTuning::kRoot.speed);
}

void LabelTracker::Predict() {
  predicted_.posture = belief_.posture;
  Invert(belief_.P_qq, &predicted_.information);
  predicted_.offset = belief_.offset;
  predicted_.offset_variance = belief_.offset_variance;
}

void LabelTracker::Expect(const Posture& posture, const MatrixXd& P, const Matrix3Xd& offset) {
  body_.kinematics.ComputeMarkers(posture.position, posture.orientation.toRotationMatrix(),
                                  posture.joint_angles, &at_);
  for (int m = 0; m < body_.num_markers(); ++m) {
    offset_W_.col(m) = at_.R_WL[body_.kinematics.link_of_marker(m)] * offset.col(m);
  }
  expected_ = at_.p_WM + offset_W_;
  body_.kinematics.ComputeJacobian(&at_);
  padded_P_.view() = P;
  Multiply(1, padded_P_, at_.J_transposed, &moved_);
  const auto J = at_.J_transposed.view();
  const auto PJ = moved_.view();
  for (int m = 0; m < body_.num_markers(); ++m) {
    covariances_[m].noalias() = J.middleCols<3>(3 * m).transpose() * PJ.middleCols<3>(3 * m);
    deviations_[m] = std::sqrt(std::max(covariances_[m].trace(), 0.0) / 3);
  }
}

void LabelTracker::Update(const Ref<const Matrix3Xd>& targets, const VectorXd& noise,
                          const Prediction& prediction, Posture* posture) {
  equations_.Place(*posture);
  equations_.Linearize(targets, noise, StepTuning::kNoRobustDistance);
  equations_.H() += prediction.information;
  equations_.g() += prediction.information * Local(*posture, prediction.posture);
  StepInsideLimits(0, 0, std::numeric_limits<double>::infinity(), body_, &equations_, posture);
}

void LabelTracker::AnnealVague(const Ref<const Matrix3Xd>& points, const Prediction& prediction,
                               const MatrixXd& P, Posture* posture) {
  VectorXd sorted = deviations_;
  std::sort(sorted.begin(), sorted.end());
  const double vague = sorted[sorted.size() * TrackTuning::kVaguePercent / 100];
  if (vague < TrackTuning::kVague) return;
  struct Predicted final : MovingBody {
    Predicted(LabelTracker* tracker, const Prediction& from) : t(*tracker), prediction(from) {}
    const Matrix3Xd& Place(const Posture& at) override {
      places = t.equations_.Place(at) + t.offset_W_;
      return places;
    }
    /// A marker is as far off as its own limb is, not the vaguest one.
    const VectorXd& Variances(double spread) override {
      variances = prediction.offset_variance.array() + t.body_.skin.array().square();
      variances.array() += t.deviations_.array().square().min(spread * spread);
      return variances;
    }
    void Step(const Matrix3Xd& targets, const VectorXd& noise, Posture* at) override {
      t.targets_ = targets - t.offset_W_;
      t.Update(t.targets_, noise, prediction, at);
    }
    LabelTracker& t;
    const Prediction& prediction;
    Matrix3Xd places;
    VectorXd variances;
  } body(this, prediction);
  Annealing annealing = TrackTuning::kAnnealing;
  annealing.from = std::min(vague, annealing.from);
  annealing.to = std::min(annealing.to, annealing.from);
  fit_.Anneal(points, annealing, &body, posture);
  Expect(*posture, P, prediction.offset);
}

void LabelTracker::ComputeCosts(int m, const Ref<const Matrix3Xd>& points, double offset_variance) {
  const double skin2 = Square(body_.skin[m]);
  Matrix3d S = covariances_[m];
  S.diagonal().array() += offset_variance + skin2;
  Matrix3d S_place = covariances_[m];
  S_place.diagonal().array() += Square(body_.place[m]) + skin2;
  const Matrix3d inverse = S.inverse();
  const Matrix3d inverse_place = S_place.inverse();
  const double size = std::log(S.determinant() / (8 * skin2 * skin2 * skin2));
  const double farthest2 = TrackTuning::kGate * 3 * S.trace();
  const Vector3d expected = expected_.col(m);
  const Vector3d model = expected - offset_W_.col(m);
  for (Eigen::Index p = 0; p < points.cols(); ++p) {
    const Vector3d r = points.col(p) - expected;
    costs_(m, p) = std::numeric_limits<double>::infinity();
    if (r.squaredNorm() > farthest2) continue;
    const double d2 = r.dot(inverse * r);
    if (d2 > TrackTuning::kGate) continue;
    const Vector3d from_model = points.col(p) - model;
    const double from_place = from_model.dot(inverse_place * from_model);
    costs_(m, p) = d2 + size + std::min(TrackTuning::kFarthestPlace, from_place);
  }
}

void LabelTracker::Assign(const Ref<const Matrix3Xd>& points, const Prediction& prediction,
                          const Hints& hints) {
  costs_.resize(body_.num_markers(), points.cols());
  for (int m = 0; m < body_.num_markers(); ++m) {
    ComputeCosts(m, points, prediction.offset_variance[m]);
  }
  for (std::size_t p = 0; p < hints.markers.size(); ++p) {
    if (hints.markers[p] >= 0) {
      costs_(hints.markers[p], static_cast<Eigen::Index>(p)) -= hints.worth[p];
    }
  }
  for (std::size_t p = 0; p < continued_.size(); ++p) {
    const int marker = continued_[p];
    const auto p_ix = static_cast<Eigen::Index>(p);
    if (marker >= 0 && !CouldBeOther(marker, p_ix)) {
      costs_(marker, p_ix) -= TrackTuning::kFarthestPlace;
    }
  }
  point_of_marker_ = assignment_.Solve(costs_, TrackTuning::kUnassigned + free_points_.Surplus());
}

bool LabelTracker::CouldBeOther(int marker, Eigen::Index point) const {
  for (int m = 0; m < body_.num_markers(); ++m) {
    if (m != marker && costs_(m, point) < TrackTuning::kUnassigned) return true;
  }
  return false;
}

bool LabelTracker::IsOnlyChoice(int marker) const {
  const double cost = costs_(marker, point_of_marker_[marker]);
  for (Eigen::Index p = 0; p < costs_.cols(); ++p) {
    if (costs_(marker, p) > cost + TrackTuning::kOnlyChoice || p == point_of_marker_[marker])
      continue;
    if (std::find(point_of_marker_.begin(), point_of_marker_.end(), p) == point_of_marker_.end()) {
      return false;
    }
  }
  return true;
}

void LabelTracker::DropLonely() {
  // Markers on a link that was lost agree with each other, or with those further out on the limb.
  for (int m = 0; m < body_.num_markers(); ++m) {
    if (point_of_marker_[m] < 0 || first_deviations_[m] < TrackTuning::kUnknown) continue;
    const std::vector<int>& joints = body_.joints_of_marker[m];
    int company = 0;
    for (int other = 0; other < body_.num_markers(); ++other) {
      if (other == m || point_of_marker_[other] < 0) continue;
      const std::vector<int>& others = body_.joints_of_marker[other];
      const bool along =
          joints.empty() || others.empty()
              ? joints.empty() && others.empty()
              : std::find(others.begin(), others.end(), joints.back()) != others.end() ||
                    std::find(joints.begin(), joints.end(), others.back()) != joints.end();
      if (along && first_deviations_[other] >= TrackTuning::kUnknown) ++company;
    }
    if (company == 0 && !IsOnlyChoice(m)) point_of_marker_[m] = -1;
  }
}

void LabelTracker::KeepContinued(const Ref<const Matrix3Xd>& points) {
  std::vector<char> is_used(static_cast<std::size_t>(points.cols()), 0);
  for (const int point : point_of_marker_) {
    if (point >= 0) is_used[point] = 1;
  }
  for (std::size_t p = 0; p < continued_.size(); ++p) {
    const int marker = continued_[p];
    const auto p_ix = static_cast<Eigen::Index>(p);
    if (marker < 0 || point_of_marker_[marker] >= 0 || is_used[p] != 0) continue;
    if (CouldBeOther(marker, p_ix)) continue;
    if ((points.col(p_ix) - expected_.col(marker)).norm() > TrackTuning::kContinued) continue;
    point_of_marker_[marker] = static_cast<int>(p);
  }
}

void LabelTracker::Settle(const Ref<const Matrix3Xd>& points, const Prediction& prediction,
                          const MatrixXd& P, const Hints& hints, Posture* posture) {
  P_ = P;
  for (int turn = 0;; ++turn) {
    if (turn > 0) Expect(*posture, P_, prediction.offset);
    Assign(points, prediction, hints);
    const bool is_near =
        turn > 0 && (expected_ - last_expected_).cwiseAbs().maxCoeff() < TrackTuning::kLinear;
    const bool is_last = turn + 1 == TrackTuning::kTurns || (is_near && point_of_marker_ == used_);
    if (is_last) DropLonely();
    if (is_last && is_near && point_of_marker_ == used_) return;
    used_ = point_of_marker_;
    last_expected_ = expected_;
    targets_.setConstant(3, body_.num_markers(), kNaN);
    for (int m = 0; m < body_.num_markers(); ++m) {
      const int point = point_of_marker_[m];
      if (point >= 0) targets_.col(m) = points.col(point) - offset_W_.col(m);
    }
    noise_ = (prediction.offset_variance.array() + body_.skin.array().square()).sqrt();
    Update(targets_, noise_, prediction, posture);
    Invert(equations_.H(), &P_);
    if (is_last) {
      Expect(*posture, P_, prediction.offset);
      return;
    }
  }
}

void LabelTracker::LookNearby(const Ref<const Matrix3Xd>& points, const Hints& hints,
                              Posture* posture) {
  const BodyMatch now = search_.Match(points, *posture);
  if (search_.MostGain(points, now) < watch_.policy().gain) return;
  BodyMatch other = search_.FindNear(points, *posture, TrackTuning::kNearby);
  if (other.cost > now.cost) other = now;
  search_.ImproveLimbs(points, TrackTuning::kLimbTries, &other);
  other = search_.SettleFinely(points, other.posture);
  if (!watch_.IsReplaced(search_.SettleFinely(points, *posture).cost, other.cost)) return;
  Start(other);
  continued_.clear();
  Predict();
  *posture = other.posture;
  Expect(*posture, belief_.P_qq, belief_.offset);
  Settle(points, predicted_, belief_.P_qq, hints, posture);
}

const std::vector<int>& LabelTracker::Track(const Ref<const Matrix3Xd>& points, double dt,
                                            const Hints& hints) {
  continued_.clear();
  for (const int last : follower_.Follow(points, dt)) {
    continued_.push_back(last < 0 ? -1 : marker_of_point_[last]);
  }
  belief_.Predict(body_, dt);
  Predict();
  Posture posture = belief_.posture;
  Expect(posture, belief_.P_qq, belief_.offset);
  first_deviations_ = deviations_;
  AnnealVague(points, predicted_, belief_.P_qq, &posture);
  Settle(points, predicted_, belief_.P_qq, hints, &posture);
  if (watch_.IsLookDue(dt)) LookNearby(points, hints, &posture);
  belief_.Correct(predicted_.information, posture, P_, &scratch_);
  belief_.ExpectSpeeds(body_, point_of_marker_, dt);
  UpdateOffsets(points, dt);
  KeepContinued(points);
  marker_of_point_.assign(static_cast<std::size_t>(points.cols()), -1);
  for (std::size_t m = 0; m < point_of_marker_.size(); ++m) {
    if (point_of_marker_[m] >= 0) marker_of_point_[point_of_marker_[m]] = static_cast<int>(m);
  }
  free_points_.Count(static_cast<int>(points.cols()), point_of_marker_, dt);
  return point_of_marker_;
}

const std::vector<int>& LabelTracker::AssignBetween(const Ref<const Matrix3Xd>& points,
                                                    const Prediction& other, const Hints& hints) {
  continued_.clear();
  Prediction both;
  both.information = predicted_.information + other.information;
  MatrixXd P;
  Invert(both.information, &P);
  both.posture = Retract(predicted_.posture,
                         P * (other.information * Local(predicted_.posture, other.posture)));
  both.offset.resize(3, body_.num_markers());
  both.offset_variance.resize(body_.num_markers());
  for (int m = 0; m < body_.num_markers(); ++m) {
    const double mine = 1 / belief_.offset_variance[m];
    const double others = 1 / other.offset_variance[m];
    both.offset.col(m) =
        (mine * belief_.offset.col(m) + others * other.offset.col(m)) / (mine + others);
    both.offset_variance[m] = 1 / (mine + others);
  }
  Posture posture = both.posture;
  Expect(posture, P, both.offset);
  first_deviations_ = deviations_;
  AnnealVague(points, both, P, &posture);
  Settle(points, both, P, hints, &posture);
  return point_of_marker_;
}

void LabelTracker::UpdateOffsets(const Ref<const Matrix3Xd>& points, double dt) {
  for (int m = 0; m < body_.num_markers(); ++m) {
    double& variance = belief_.offset_variance[m];
    const double place = Square(body_.place[m]);
    const int point = point_of_marker_[m];
    if (point < 0) {
      variance = std::min(place, variance + place * std::min(1.0, dt / TrackTuning::kOffsetMemory));
      continue;
    }
    const Eigen::Matrix3d& R_WL = at_.R_WL[body_.kinematics.link_of_marker(m)];
    const Vector3d r = R_WL.transpose() * (points.col(point) - at_.p_WM.col(m));
    const double noise = Square(body_.skin[m]) + Square(deviations_[m]);
    variance = std::min(place, variance + Square(TrackTuning::kOffsetDrift) * dt);
    const double gain = variance / (variance + noise);
    belief_.offset.col(m) += gain * (r - belief_.offset.col(m));
    variance *= 1 - gain;
  }
}

}  // namespace mmm_converter
