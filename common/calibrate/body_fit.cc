// SPDX-License-Identifier: MIT
#include "common/calibrate/body_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "common/calibrate/frame_equations.h"
#include "common/calibrate/offset_prior.h"
#include "common/math/dense.h"
#include "common/math/square.h"
#include "common/model/kit_joints.h"
#include "common/support/parallel.h"

namespace mmm_converter {

using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double kLeastScale = 0.5;
constexpr double kMostScale = 2;
constexpr int kMostIterations = 150;
// A step that gains less has arrived: one unit is a standard deviation's worth of evidence.
constexpr double kLeastGain = 0.05;
constexpr double kLeastDamping = 1e-7;
constexpr double kMostDamping = 1e6;
// Frames are summed up in so many parts, whatever the number of threads: the same sum each time.
constexpr int kParts = 8;

/// U with U' U the information about three scales of scale_deviation each, whose common part leaves
/// axis_deviation to each.
Eigen::Matrix3d AxesFactor(const CalibrationOptions& options) {
  const double own = Square(options.axis_deviation);
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Constant(Square(options.scale_deviation) - own);
  covariance.diagonal().array() += own;
  return covariance.inverse().llt().matrixU();
}

/// Information about the scales of a person of known height: the mean of left and right is 1 by
/// scale_deviation, their difference 0 by side_deviation.
MatrixXd OwnScalePrior(const SegmentLengths& lengths, const CalibrationOptions& options) {
  const auto n = static_cast<Eigen::Index>(lengths.segments.size());
  MatrixXd A = MatrixXd::Identity(n, n) / options.scale_deviation;
  for (const auto& [left, right] : lengths.mirror) {
    A(left, left) = A(left, right) = 0.5 / options.scale_deviation;
    A(right, left) = 1 / options.side_deviation;
    A(right, right) = -1 / options.side_deviation;
  }
  for (Eigen::Index i = 0; lengths.are_of_axes && i < n; i += 3) {
    const bool is_difference = A.block(i, i, 3, 3).minCoeff() < 0;
    if (is_difference) continue;
    A.middleRows<3>(i) = AxesFactor(options) * options.scale_deviation * A.middleRows<3>(i).eval();
  }
  return A.transpose() * A;
}

/// How the scales tell the height: what they have in common beyond 1 is weights' * (scales - 1),
/// with `variance` where they are known.
struct CommonScale {
  VectorXd weights;
  double variance = 0;
};

CommonScale FindCommonScale(const MatrixXd& own_prior, double height_deviation) {
  const VectorXd pull = own_prior.rowwise().sum();
  const double variance = 1 / (1 / Square(height_deviation) + pull.sum());
  return {variance * pull, variance};
}

/// Information about the scales before any recording; where the height is a guess, they have an
/// unknown part in common (Woodbury).
MatrixXd ScalePrior(const SegmentLengths& lengths, const CalibrationOptions& options) {
  MatrixXd own = OwnScalePrior(lengths, options);
  if (options.height_deviation <= 0) return own;
  const CommonScale common = FindCommonScale(own, options.height_deviation);
  return own - common.weights * common.weights.transpose() / common.variance;
}

/// Of each frame, what it says that no other one says too: skin that moves as an Ornstein-Uhlenbeck
/// process is much the same in frames near each other.
VectorXd OwnShares(const std::vector<CalibrationFrame>& frames, double skin_time) {
  VectorXd repeated = VectorXd::Zero(static_cast<Eigen::Index>(frames.size()));
  for (std::size_t k = 0; k < frames.size(); ++k) {
    for (const CalibrationFrame& other : frames) {
      if (other.recording != frames[k].recording) continue;
      repeated[static_cast<Eigen::Index>(k)] +=
          std::exp(-std::abs(other.time - frames[k].time) / skin_time);
    }
  }
  return repeated.cwiseInverse();
}

/// A place that is known well has no better skin.
VectorXd SkinDeviationsOf(const CalibrationOptions& options, const VectorXd& noise_scale) {
  if (!options.places_by_noise) return options.skin_deviation * noise_scale;
  return VectorXd::Constant(noise_scale.size(), options.skin_deviation);
}

/// What is known of the mean posture, as FrameEquations::DrawTo takes it.
VectorXd PostureInformation(const BodyKinematics& kinematics, const CalibrationOptions& options) {
  // Hips' and other limbs' own rotation differs most between sessions (McGinley et al. 2009).
  constexpr double kOfRotation = 2;
  constexpr double kAlongLimb = 0.9;  // the cosine
  const std::vector<int>& joints = kinematics.joints();
  VectorXd deviations = VectorXd::Constant(3 + static_cast<Eigen::Index>(joints.size()),
                                           options.mean_posture_deviation);
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const Segment& joint = kinematics.model().joint(joints[j]);
    const std::string limb = LimbOfJoint(joint.name);
    double& deviation = deviations[static_cast<Eigen::Index>(3 + j)];
    if (std::abs(joint.axis.z()) > kAlongLimb) deviation *= kOfRotation;
    // Trunk and neck have two joints each about the same axis.
    if (limb == "spine" || limb == "head") deviation /= std::sqrt(2);
  }
  return deviations.cwiseAbs2().cwiseInverse();
}

class BodyFit {
 public:
  BodyFit(BodyKinematics* kinematics, const CalibrationOptions& options,
          const VectorXd& noise_scale, std::vector<CalibrationFrame>* frames, Body* body)
      : kinematics_(*kinematics),
        options_(options),
        frames_(*frames),
        body_(*body),
        trial_body_(*body),
        offset_prior_(*kinematics, options, PlaceDeviations(options, noise_scale)),
        scale_prior_(ScalePrior(kinematics->lengths(), options)),
        trial_(frames->size()),
        costs_(static_cast<Eigen::Index>(frames->size())),
        total_(*kinematics),
        reduced_(*kinematics),
        parts_(kParts, total_),
        model_kinematics_(kinematics->model(), kinematics->joints(), kinematics->markers()),
        solvers_(kParts, NormalEquations(model_kinematics_)) {
    equations_.reserve(frames->size());
    const VectorXd shares = OwnShares(*frames, options.skin_time);
    for (std::size_t k = 0; k < frames->size(); ++k) {
      equations_.emplace_back(*kinematics, (*frames)[k].z, SkinDeviationsOf(options, noise_scale),
                              shares[static_cast<Eigen::Index>(k)]);
    }
    if (options.mean_posture_deviation <= 0) return;
    const VectorXd information = PostureInformation(*kinematics, options) / shares.sum();
    for (std::size_t k = 0; k < frames->size(); ++k) {
      equations_[k].DrawTo((*frames)[k].by_places, information);
    }
  }

  BodyFitResult Solve();

 private:
  void ForEachPart(const std::function<void(int, std::size_t)>& body) {
    ParallelFor(kParts, 0, [&](int part) {
      const std::size_t n = frames_.size();
      for (std::size_t k = n * part / kParts; k < n * (part + 1) / kParts; ++k) body(part, k);
    });
  }

  double Cost(const Body& body, const std::vector<Posture>& postures);
  double PriorCost(const Body& body) const;
  void Linearize();
  void AddPrior();
  void Reduce(double damping);
  double TryStep(double damping);
  Body Deviations(BodyFitResult* result);

  BodyKinematics& kinematics_;
  const CalibrationOptions& options_;
  std::vector<CalibrationFrame>& frames_;
  Body& body_;
  Body trial_body_;
  OffsetPrior offset_prior_;
  MatrixXd scale_prior_;
  std::vector<Posture> trial_;
  VectorXd costs_;
  BodyEquations total_;
  BodyEquations reduced_;
  std::vector<BodyEquations> parts_;
  MarkerKinematics model_kinematics_;
  std::vector<NormalEquations> solvers_;
  std::vector<FrameEquations> equations_;
};

double BodyFit::Cost(const Body& body, const std::vector<Posture>& postures) {
  kinematics_.SetBody(body);
  ForEachPart([&](int /*part*/, std::size_t k) {
    costs_[static_cast<Eigen::Index>(k)] = equations_[k].Cost(kinematics_, postures[k]);
  });
  return costs_.sum() + PriorCost(body);
}

double BodyFit::PriorCost(const Body& body) const {
  const VectorXd d = body.scales.array() - 1;
  return offset_prior_.Cost(body.offsets) + d.dot(scale_prior_ * d);
}

void BodyFit::AddPrior() {
  offset_prior_.Add(body_.offsets, &total_);
  const Eigen::Index scales = body_.scales.size();
  total_.H.view().bottomRightCorner(scales, scales) += scale_prior_;
  total_.g.tail(scales) -= scale_prior_ * (body_.scales.array() - 1).matrix();
}

void BodyFit::Linearize() {
  for (BodyEquations& part : parts_) part.SetZero();
  ForEachPart([&](int part, std::size_t k) {
    equations_[k].Linearize(kinematics_, frames_[k].posture, &parts_[part]);
  });
  total_.SetZero();
  for (const BodyEquations& part : parts_) total_.Add(part);
  AddPrior();
}

void BodyFit::Reduce(double damping) {
  for (BodyEquations& part : parts_) part.SetZero();
  ForEachPart([&](int part, std::size_t k) { equations_[k].Eliminate(damping, &parts_[part]); });
  reduced_ = total_;
  reduced_.H.view().diagonal() *= 1 + damping;
  for (const BodyEquations& part : parts_) reduced_.Add(part);
}

double BodyFit::TryStep(double damping) {
  Reduce(damping);
  Factorize(&reduced_.H);
  PaddedMatrix solution(reduced_.size(), 1);
  solution.view().col(0) = reduced_.g;
  SolveLower(reduced_.H, &solution);
  SolveLowerTransposed(reduced_.H, &solution);
  const VectorXd step = solution.view().col(0);
  trial_body_.offsets =
      body_.offsets + step.head(body_.offsets.size()).reshaped(3, Eigen::AutoSize);
  trial_body_.scales =
      (body_.scales + step.tail(body_.scales.size())).cwiseMax(kLeastScale).cwiseMin(kMostScale);
  const MarkerKinematics& markers = model_kinematics_;
  ForEachPart([&](int part, std::size_t k) {
    const Posture& posture = frames_[k].posture;
    trial_[k] = Retract(posture, equations_[k].Step(step, posture, damping, &solvers_[part]));
    trial_[k].joint_angles =
        trial_[k].joint_angles.cwiseMax(markers.lower()).cwiseMin(markers.upper());
  });
  return Cost(trial_body_, trial_);
}

Body BodyFit::Deviations(BodyFitResult* result) {
  // What places tell of postures they tell of the body already.
  for (FrameEquations& frame : equations_) frame.DrawTo({}, {});
  Linearize();
  Reduce(0);
  const MatrixXd H = reduced_.H.view().selfadjointView<Eigen::Lower>();
  const MatrixXd P = H.ldlt().solve(MatrixXd::Identity(H.rows(), H.cols()));
  if (options_.height_deviation > 0) {
    const CommonScale common =
        FindCommonScale(OwnScalePrior(kinematics_.lengths(), options_), options_.height_deviation);
    const Eigen::Index n = body_.scales.size();
    result->common_scale = common.weights.dot((body_.scales.array() - 1).matrix());
    result->common_deviation =
        std::sqrt(common.variance + common.weights.dot(P.bottomRightCorner(n, n) * common.weights));
  }
  result->joint_slopes.setZero(static_cast<Eigen::Index>(kinematics_.joints().size()), P.cols());
  for (const FrameEquations& frame : equations_) {
    result->joint_slopes += frame.Slopes().bottomRows(result->joint_slopes.rows()) /
                            static_cast<double>(equations_.size());
  }
  result->covariance = P;
  result->side_correlation = offset_prior_.LikelyCorrelation(body_.offsets, P);
  const VectorXd deviations = P.diagonal().cwiseMax(0).cwiseSqrt();
  return {deviations.tail(body_.scales.size()),
          deviations.head(body_.offsets.size()).reshaped(3, Eigen::AutoSize)};
}

BodyFitResult BodyFit::Solve() {
  BodyFitResult result;
  for (std::size_t k = 0; k < frames_.size(); ++k) trial_[k] = frames_[k].posture;
  result.cost = Cost(body_, trial_);
  double damping = 1e-3;
  while (!result.converged && result.iterations < kMostIterations) {
    Linearize();
    for (bool accepted = false; !accepted && !result.converged;) {
      ++result.iterations;
      if (options_.between_steps) options_.between_steps();
      const double cost = TryStep(damping);
      accepted = cost < result.cost;
      if (!accepted) {
        damping *= 5;
        result.converged = damping > kMostDamping;
        continue;
      }
      result.converged = result.cost - cost < kLeastGain;
      result.cost = cost;
      std::swap(body_, trial_body_);
      for (std::size_t k = 0; k < frames_.size(); ++k) frames_[k].posture = trial_[k];
      damping = std::max(damping * 0.4, kLeastDamping);
    }
  }
  kinematics_.SetBody(body_);
  for (std::size_t k = 0; k < frames_.size(); ++k) trial_[k] = frames_[k].posture;
  Cost(body_, trial_);
  result.deviations = Deviations(&result);
  result.prior_scale_deviations =
      scale_prior_.ldlt()
          .solve(MatrixXd::Identity(scale_prior_.rows(), scale_prior_.cols()))
          .diagonal()
          .cwiseSqrt();
  return result;
}

}  // namespace

VectorXd PlaceDeviations(const CalibrationOptions& options, const VectorXd& noise_scale) {
  if (options.places_by_noise) return options.marker_deviation * noise_scale;
  return VectorXd::Constant(noise_scale.size(), options.marker_deviation);
}

BodyFitResult FitBody(BodyKinematics* kinematics, const CalibrationOptions& options,
                      const VectorXd& noise_scale, std::vector<CalibrationFrame>* frames,
                      Body* body) {
  return BodyFit(kinematics, options, noise_scale, frames, body).Solve();
}

}  // namespace mmm_converter
