// SPDX-License-Identifier: MIT
#include "common/label/track/label_tracker.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

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

namespace {

constexpr double kOffsetMemory = 1.0;   // [s] in which a hidden marker's place is forgotten
constexpr double kOffsetDrift = 0.004;  // [m / sqrt(s)] of a seen one

constexpr double kUnassigned = 21.1;  // chi-square of three, exceeded once in 10,000
constexpr double kGate = 2 * kUnassigned;
constexpr double kFarthestPlace = 12;  // most that the distance from the model's place costs
constexpr double kVague = 0.012;       // [m]: beyond, soft assignment comes first
constexpr double kLost = 0.05;         // [m]: beyond, a limb is not taken up by one point
constexpr int kTurns = 3;

}  // namespace

LabelTracker::LabelTracker(const LabelBody& body)
    : body_(body),
      scratch_(body.kinematics.num_dofs()),
      search_(body),
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

void LabelTracker::Foresee(double dt, Matrix3Xd* places, VectorXd* variances) {
  Expect(belief_.PostureAfter(body_, dt), belief_.P_qq);
  *places = expected_;
  *variances = deviations_.array().square() + belief_.offset_variance.array() +
               body_.skin.array().square() + Square(dt * LabelBelief::kRootSpeed);
}

void LabelTracker::Expect(const Posture& posture, const MatrixXd& P) {
  body_.kinematics.ComputeMarkers(posture.position, posture.orientation.toRotationMatrix(),
                                  posture.joint_angles, &at_);
  for (int m = 0; m < body_.num_markers(); ++m) {
    offset_W_.col(m) = at_.R_WL[body_.kinematics.link_of_marker(m)] * belief_.offset.col(m);
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
                          Posture* posture) {
  constexpr double kNoLimit = 1e9;
  constexpr int kSolves = 3;
  const int joints = body_.kinematics.num_joints();
  equations_.Place(*posture);
  equations_.Linearize(targets, noise, kNoLimit);
  equations_.H() += prior_;
  equations_.g() += prior_ * Local(*posture, predicted_);
  equations_.HoldPressingJoints(posture->joint_angles);
  equations_.Solve(0, 0);
  for (int i = 1; i < kSolves && equations_.HoldOversteppingJoints(posture->joint_angles); ++i) {
    equations_.Solve(0, 0);
  }
  const VectorXd& step = equations_.step();
  posture->position += step.head<3>();
  posture->orientation = (posture->orientation * Exp(step.segment<3>(3))).normalized();
  posture->joint_angles = (posture->joint_angles + step.tail(joints))
                              .cwiseMax(body_.kinematics.lower())
                              .cwiseMin(body_.kinematics.upper());
}

bool LabelTracker::DrawSoftly(const Ref<const Matrix3Xd>& points, Posture* posture) {
  constexpr int kSteps = 6;
  constexpr double kWidest = 0.2;
  constexpr double kNarrowest = 0.02;
  VectorXd sorted = deviations_;
  std::sort(sorted.begin(), sorted.end());
  const double vague = sorted[sorted.size() * 9 / 10];
  if (vague < kVague) return false;
  const double from = std::min(vague, kWidest);
  for (int i = 0; i < kSteps; ++i) {
    const double spread = from * std::pow(std::min(kNarrowest / from, 1.0), i / (kSteps - 1.0));
    noise_ = belief_.offset_variance.array() + body_.skin.array().square();
    // A marker is as far off as its own limb is, not the vaguest one.
    const VectorXd variances = noise_.array() + deviations_.array().square().min(spread * spread);
    soft_.Compute(equations_.Place(*posture) + offset_W_, variances, points);
    targets_ = soft_.targets() - offset_W_;
    noise_ = (variances.array() / soft_.weights().array().max(1e-9)).sqrt();
    Update(targets_, noise_, posture);
  }
  return true;
}

void LabelTracker::AssignMarker(int m, const Ref<const Matrix3Xd>& points) {
  const double skin2 = Square(body_.skin[m]);
  Matrix3d S = covariances_[m];
  S.diagonal().array() += belief_.offset_variance[m] + skin2;
  Matrix3d S_place = covariances_[m];
  S_place.diagonal().array() += Square(body_.place[m]) + skin2;
  const Matrix3d inverse = S.inverse();
  const Matrix3d inverse_place = S_place.inverse();
  const double size = std::log(S.determinant() / (8 * skin2 * skin2 * skin2));
  const double farthest2 = kGate * 3 * S.trace();
  const Vector3d expected = expected_.col(m);
  const Vector3d model = expected - offset_W_.col(m);
  for (Eigen::Index p = 0; p < points.cols(); ++p) {
    const Vector3d r = points.col(p) - expected;
    costs_(m, p) = std::numeric_limits<double>::infinity();
    if (r.squaredNorm() > farthest2) continue;
    const double d2 = r.dot(inverse * r);
    if (d2 > kGate) continue;
    const Vector3d from_model = points.col(p) - model;
    const double from_place = from_model.dot(inverse_place * from_model);
    costs_(m, p) = d2 + size + std::min(kFarthestPlace, from_place);
  }
}

void LabelTracker::Assign(const Ref<const Matrix3Xd>& points) {
  costs_.resize(body_.num_markers(), points.cols());
  for (int m = 0; m < body_.num_markers(); ++m) AssignMarker(m, points);
  if (hints_ != nullptr) {
    for (std::size_t p = 0; p < hints_->markers.size(); ++p) {
      if (hints_->markers[p] >= 0) {
        costs_(hints_->markers[p], static_cast<Eigen::Index>(p)) -= hints_->worth[p];
      }
    }
  }
  for (std::size_t p = 0; p < continued_.size(); ++p) {
    const int marker = continued_[p];
    const auto p_ix = static_cast<Eigen::Index>(p);
    if (marker >= 0 && !CouldBeOther(marker, p_ix)) costs_(marker, p_ix) -= kFarthestPlace;
  }
  point_of_marker_ = assignment_.Solve(costs_, kUnassigned + free_points_.Surplus());
}

bool LabelTracker::CouldBeOther(int marker, Eigen::Index point) const {
  for (int m = 0; m < body_.num_markers(); ++m) {
    if (m != marker && costs_(m, point) < kUnassigned) return true;
  }
  return false;
}

bool LabelTracker::IsOnlyChoice(int marker) const {
  constexpr double kClearly = 9;
  const double cost = costs_(marker, point_of_marker_[marker]);
  for (Eigen::Index p = 0; p < costs_.cols(); ++p) {
    if (costs_(marker, p) > cost + kClearly || p == point_of_marker_[marker]) continue;
    if (std::find(point_of_marker_.begin(), point_of_marker_.end(), p) == point_of_marker_.end()) {
      return false;
    }
  }
  return true;
}

void LabelTracker::DropLonely() {
  // Markers on a link that was lost agree with each other, or with those further out on the limb.
  for (int m = 0; m < body_.num_markers(); ++m) {
    if (point_of_marker_[m] < 0 || first_deviations_[m] < kLost) continue;
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
      if (along && first_deviations_[other] >= kLost) ++company;
    }
    if (company == 0 && !IsOnlyChoice(m)) point_of_marker_[m] = -1;
  }
}

void LabelTracker::Continue(const Ref<const Matrix3Xd>& points) {
  constexpr double kFarthest = 0.15;  // [m] from where the marker is expected
  std::vector<char> is_used(static_cast<std::size_t>(points.cols()), 0);
  for (const int point : point_of_marker_) {
    if (point >= 0) is_used[point] = 1;
  }
  for (std::size_t p = 0; p < continued_.size(); ++p) {
    const int marker = continued_[p];
    const auto p_ix = static_cast<Eigen::Index>(p);
    if (marker < 0 || point_of_marker_[marker] >= 0 || is_used[p] != 0) continue;
    if (CouldBeOther(marker, p_ix)) continue;
    if ((points.col(p_ix) - expected_.col(marker)).norm() > kFarthest) continue;
    point_of_marker_[marker] = static_cast<int>(p);
  }
}

void LabelTracker::Settle(const Ref<const Matrix3Xd>& points, const MatrixXd& P, Posture* posture) {
  constexpr double kClose = 0.02;  // [m]: a step so short is as good as linear
  P_ = P;
  for (int turn = 0;; ++turn) {
    if (turn > 0) Expect(*posture, P_);
    Assign(points);
    const bool is_near = turn > 0 && (expected_ - last_expected_).cwiseAbs().maxCoeff() < kClose;
    const bool is_last = turn + 1 == kTurns || (is_near && point_of_marker_ == used_);
    if (is_last) DropLonely();
    if (is_last && is_near && point_of_marker_ == used_) return;
    used_ = point_of_marker_;
    last_expected_ = expected_;
    targets_.setConstant(3, body_.num_markers(), kNaN);
    for (int m = 0; m < body_.num_markers(); ++m) {
      const int point = point_of_marker_[m];
      if (point >= 0) targets_.col(m) = points.col(point) - offset_W_.col(m);
    }
    noise_ = (belief_.offset_variance.array() + body_.skin.array().square()).sqrt();
    Update(targets_, noise_, posture);
    Invert(equations_.H(), &P_);
    if (is_last) {
      Expect(*posture, P_);
      return;
    }
  }
}

void LabelTracker::Doubt(const Ref<const Matrix3Xd>& points, Posture* posture) {
  constexpr int kAttempts = 20;
  constexpr double kGain = 8.5;  // a lone marker that lacks its point says as much
  const BodyMatch now = search_.Match(points, *posture);
  if (search_.MostGain(points, now) < kGain) return;
  BodyMatch other = search_.FindNear(points, *posture, 0.06);
  if (other.cost > now.cost) other = now;
  search_.ImproveLimbs(points, kAttempts, &other);
  other = search_.SettleFinely(points, other.posture);
  if (other.cost > search_.SettleFinely(points, *posture).cost - kGain) return;
  Start(other);
  continued_.clear();
  predicted_ = other.posture;
  Invert(belief_.P_qq, &prior_);
  *posture = other.posture;
  Expect(*posture, belief_.P_qq);
  Settle(points, belief_.P_qq, posture);
}

const std::vector<int>& LabelTracker::Track(const Ref<const Matrix3Xd>& points, double dt,
                                            const Hints* hints) {
  constexpr double kDoubtEvery = 0.1;  // [s]
  hints_ = hints;
  continued_.clear();
  for (const int last : follower_.Follow(points, dt)) {
    continued_.push_back(last < 0 ? -1 : marker_of_point_[last]);
  }
  belief_.Predict(body_, dt);
  predicted_ = belief_.posture;
  Posture posture = predicted_;
  Invert(belief_.P_qq, &prior_);
  Expect(predicted_, belief_.P_qq);
  first_deviations_ = deviations_;
  if (DrawSoftly(points, &posture)) Expect(posture, belief_.P_qq);
  Settle(points, belief_.P_qq, &posture);
  since_doubt_ += dt;
  if (since_doubt_ >= kDoubtEvery) {
    since_doubt_ = 0;
    Doubt(points, &posture);
  }
  belief_.Correct(prior_, posture, P_, &scratch_);
  belief_.ExpectSpeeds(body_, point_of_marker_, dt);
  Learn(points, dt);
  Continue(points);
  marker_of_point_.assign(static_cast<std::size_t>(points.cols()), -1);
  for (std::size_t m = 0; m < point_of_marker_.size(); ++m) {
    if (point_of_marker_[m] >= 0) marker_of_point_[point_of_marker_[m]] = static_cast<int>(m);
  }
  free_points_.Count(static_cast<int>(points.cols()), point_of_marker_, dt);
  return point_of_marker_;
}

const std::vector<int>& LabelTracker::Between(const Ref<const Matrix3Xd>& points,
                                              const Prediction& other, const Hints* hints) {
  const LabelBelief belief = belief_;
  const Posture predicted = predicted_;
  hints_ = hints;
  continued_.clear();
  const MatrixXd information = prior_ + other.information;
  MatrixXd P;
  Invert(information, &P);
  predicted_ = Retract(predicted, P * (other.information * Local(predicted, other.posture)));
  prior_ = information;
  for (int m = 0; m < body_.num_markers(); ++m) {
    const double mine = 1 / belief_.offset_variance[m];
    const double others = 1 / other.offset_variance[m];
    belief_.offset.col(m) =
        (mine * belief.offset.col(m) + others * other.offset.col(m)) / (mine + others);
    belief_.offset_variance[m] = 1 / (mine + others);
  }
  Posture posture = predicted_;
  Expect(posture, P);
  first_deviations_ = deviations_;
  if (DrawSoftly(points, &posture)) Expect(posture, P);
  Settle(points, P, &posture);
  belief_ = belief;
  return point_of_marker_;
}

void LabelTracker::Learn(const Ref<const Matrix3Xd>& points, double dt) {
  for (int m = 0; m < body_.num_markers(); ++m) {
    double& variance = belief_.offset_variance[m];
    const double place = Square(body_.place[m]);
    const int point = point_of_marker_[m];
    if (point < 0) {
      variance = std::min(place, variance + place * std::min(1.0, dt / kOffsetMemory));
      continue;
    }
    const Eigen::Matrix3d& R_WL = at_.R_WL[body_.kinematics.link_of_marker(m)];
    const Vector3d r = R_WL.transpose() * (points.col(point) - at_.p_WM.col(m));
    const double noise = Square(body_.skin[m]) + Square(deviations_[m]);
    variance = std::min(place, variance + Square(kOffsetDrift) * dt);
    const double gain = variance / (variance + noise);
    belief_.offset.col(m) += gain * (r - belief_.offset.col(m));
    variance *= 1 - gain;
  }
}

}  // namespace mmm_converter
